#include "study/journal.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "core/error.h"
#include "study/row_bytes.h"
#include "study/sqlite.h"

namespace asdic::study {
namespace {

constexpr std::string_view format = "asdic journal 1";
constexpr auto commit_after = std::chrono::milliseconds(500);

// Without a rowid's own tree for time series, rows stay small and quick to read through.
constexpr const char* schema =
    "CREATE TABLE IF NOT EXISTS meta(key TEXT PRIMARY KEY, value TEXT);"
    "CREATE TABLE IF NOT EXISTS session(id INTEGER PRIMARY KEY, text TEXT);"
    "CREATE TABLE IF NOT EXISTS row(idx INTEGER PRIMARY KEY, valid INTEGER, fault TEXT,"
    " vals BLOB, kept INTEGER, checksum TEXT);"
    "CREATE TABLE IF NOT EXISTS series(idx INTEGER PRIMARY KEY, shape TEXT, pressure BLOB,"
    " checksum TEXT);";

}  // namespace

struct Journal::Impl {
  explicit Impl(const std::filesystem::path& path) : database(path) {
    database.execute("PRAGMA locking_mode=EXCLUSIVE");  // no shared memory: works over a network
    database.execute("PRAGMA journal_mode=WAL");
    database.execute("PRAGMA synchronous=FULL");
    database.execute("BEGIN EXCLUSIVE");
    database.execute(schema);
    database.execute("COMMIT");
  }

  [[nodiscard]] std::string meta(const std::string& key) {
    sqlite::Statement get(database, "SELECT value FROM meta WHERE key=?");
    get.bind(0, key);
    return get.step() ? get.text(0) : "";
  }

  void set_meta(const std::string& key, const std::string& value) {
    sqlite::Statement(database, "REPLACE INTO meta VALUES(?,?)").bind(0, key).bind(1, value).run();
  }

  /// From now on it is this study's.
  void take_over(const Imprint& imprint) {
    database.execute("BEGIN");
    set_meta("identity", imprint.identity);
    set_meta("columns", to_json(imprint.columns));
    set_meta("study", imprint.text);
    set_meta("format", std::string(format));
    database.execute("COMMIT");
    identity = imprint.identity;
  }

  [[nodiscard]] std::int64_t count_rows() const {
    sqlite::Statement count(database, "SELECT COUNT(*) FROM row");
    return count.step() ? count.integer(0) : 0;
  }

  /// Which rows are there, without a look at what is in them.
  void find_done() {
    sqlite::Statement get(database, "SELECT idx FROM row ORDER BY idx");
    while (get.step()) done.add(static_cast<std::uint64_t>(get.integer(0)));
  }

  void check_format() {
    if (const std::string found = meta("format"); found != format)
      throw InputError({.where = database.path().string(),
                        .got = found.empty() ? "a database that is no journal" : found,
                        .expected = std::string(format)});
  }

  void check_rows();
  void start();
  void append(const Row& row);
  void commit();
  void close();
  void finish_session();
  [[nodiscard]] Row row_at(const sqlite::Statement& get) const;
  [[nodiscard]] bool add_series(Row& row) const;
  void drop(std::uint64_t index) const;
  [[nodiscard]] std::int64_t next_session() const {
    sqlite::Statement next(database, "SELECT COALESCE(MAX(id),0)+1 FROM session");
    return next.step() ? next.integer(0) : 1;
  }

  sqlite::Database database;
  std::string identity;
  IndexSet done;
  std::uint64_t damaged = 0;

  mutable std::mutex mutex;  // of everything below and of the connection
  std::optional<sqlite::Statement> insert_row, insert_series;
  bool pending = false;  // a transaction is open
  std::exception_ptr fault;
  std::optional<Session> session;
  std::int64_t session_id = 0;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  std::jthread committer;  // the last: it is joined before the rest goes
};

/// Every row is looked at once: those that do not match their checksum go.
void Journal::Impl::check_rows() {
  std::vector<std::uint64_t> bad;
  {
    sqlite::Statement get(
        database,
        "SELECT r.idx,r.valid,r.fault,r.vals,r.kept,r.checksum,COALESCE(s.idx,-1) FROM row r"
        " LEFT JOIN series s ON s.idx=r.idx ORDER BY r.idx");
    while (get.step()) {
      const Row row = row_at(get);
      const bool kept = get.integer(4) != 0;
      if (get.text(5) == checksum(row, kept) && (!kept || get.integer(6) == get.integer(0)))
        done.add(row.index);
      else
        bad.push_back(row.index);
    }
  }
  for (const std::uint64_t index : bad) drop(index);
  damaged = bad.size();
}

Row Journal::Impl::row_at(const sqlite::Statement& get) const {
  return {.index = static_cast<std::uint64_t>(get.integer(0)),
          .valid = get.integer(1) != 0,
          .fault = get.text(2),
          .values = vector_of<double>(get.blob(3)),
          .pressure = {},
          .pressure_shape = {}};
}

bool Journal::Impl::add_series(Row& row) const {
  sqlite::Statement get(database, "SELECT shape,pressure,checksum FROM series WHERE idx=?");
  get.bind(0, static_cast<std::int64_t>(row.index));
  if (!get.step()) return false;
  const std::string shape = get.text(0);
  row.pressure_shape = shape_of(shape);
  row.pressure = vector_of<float>(get.blob(1));
  return checksum_of_series(row.index, shape, get.blob(1)) == get.text(2);
}

void Journal::Impl::drop(std::uint64_t index) const {
  for (const char* sql : {"DELETE FROM row WHERE idx=?", "DELETE FROM series WHERE idx=?"})
    sqlite::Statement(database, sql).bind(0, static_cast<std::int64_t>(index)).run();
}

void Journal::Impl::start() {
  check_rows();
  insert_row.emplace(database, "REPLACE INTO row VALUES(?,?,?,?,?,?)");
  insert_series.emplace(database, "REPLACE INTO series VALUES(?,?,?,?)");
  committer = std::jthread([this](const std::stop_token& over) {
    using Clock = std::chrono::steady_clock;
    auto last = Clock::now();
    while (!over.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (Clock::now() - last < commit_after) continue;
      last = Clock::now();
      const std::lock_guard lock(mutex);
      try {
        commit();
      } catch (...) {
        if (!fault) fault = std::current_exception();
      }
    }
  });
}

void Journal::Impl::append(const Row& row) {
  if (fault) std::rethrow_exception(fault);
  if (!pending) database.execute("BEGIN");
  pending = true;
  Row clean{.index = row.index, .valid = row.valid, .fault = row.fault, .values = row.values};
  one_kind_of_nan(clean.values);
  const bool kept = !row.pressure.empty();
  const auto index = static_cast<std::int64_t>(row.index);
  const std::string sum = checksum(clean, kept);
  insert_row->bind(0, index)
      .bind(1, std::int64_t{row.valid})
      .bind(2, row.fault)
      .bind(3, bytes_of(clean.values))
      .bind(4, std::int64_t{kept})
      .bind(5, sum)
      .run();
  if (kept) {
    const std::string shape = shape_text(row.pressure_shape);
    const std::string series_sum = checksum_of_series(row.index, shape, bytes_of(row.pressure));
    insert_series->bind(0, index)
        .bind(1, shape)
        .bind(2, bytes_of(row.pressure))
        .bind(3, series_sum)
        .run();
  }
  done.add(row.index);
  if (session) ++session->rows;
}

void Journal::Impl::commit() {
  if (!pending) return;
  if (session) finish_session();
  database.execute("COMMIT");
  pending = false;
}

void Journal::Impl::finish_session() {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  session->seconds = wall.count();
  const std::string text = to_json(*session);
  sqlite::Statement(database, "REPLACE INTO session VALUES(?,?)")
      .bind(0, session_id)
      .bind(1, text)
      .run();
}

void Journal::Impl::close() {
  committer = {};  // asked to stop, and joined
  const std::lock_guard lock(mutex);
  if (fault) std::rethrow_exception(std::exchange(fault, nullptr));
  commit();
  insert_row.reset();
  insert_series.reset();
  database.close();
}

Journal::Journal(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {
  impl_->check_format();
  impl_->identity = impl_->meta("identity");
  impl_->start();
}

Journal::Journal(const std::filesystem::path& path, const Imprint& imprint)
    : impl_(std::make_unique<Impl>(path)) {
  if (impl_->meta("format").empty()) impl_->take_over(imprint);
  impl_->check_format();
  impl_->identity = impl_->meta("identity");
  if (const std::int64_t rows = impl_->count_rows();
      impl_->identity != imprint.identity && rows > 0)
    throw InputError(
        {.where = path.string(),
         .got = (rows == 1 ? "a realisation" : std::to_string(rows) + " realisations") +
                " of another study" + how_changed(impl_->meta("study"), imprint.text) +
                " (identity " + impl_->identity + ")",
         .expected = "those of this one (identity " + imprint.identity +
                     "): --fresh throws them away and begins anew, another -o keeps "
                     "them"});
  if (impl_->identity != imprint.identity) impl_->take_over(imprint);
  if (impl_->meta("columns") != to_json(imprint.columns))
    throw InputError({.where = path.string(),
                      .got = "rows with other columns, of another version of asdic",
                      .expected = "those of this one; --fresh begins anew"});
  impl_->start();
}

Journal::~Journal() {
  if (impl_ == nullptr) return;
  try {
    if (impl_->database.get() != nullptr) impl_->close();
  } catch (const std::exception&) {
    // whoever wants to hear of it calls close()
  }
}

Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;

void Journal::begin(const Session& session) {
  const std::lock_guard lock(impl_->mutex);
  impl_->commit();
  impl_->session = session;
  impl_->session->rows = 0;
  impl_->began = std::chrono::steady_clock::now();
  impl_->session_id = impl_->next_session();
}

void Journal::add(const Session& session) {
  const std::lock_guard lock(impl_->mutex);
  const std::string text = to_json(session);
  sqlite::Statement(impl_->database, "INSERT INTO session VALUES(?,?)")
      .bind(0, impl_->next_session())
      .bind(1, text)
      .run();
}

void Journal::append(const Row& row) {
  const std::lock_guard lock(impl_->mutex);
  impl_->append(row);
}

void Journal::drop_skipped() {
  const std::lock_guard lock(impl_->mutex);
  std::vector<std::uint64_t> skipped;
  {
    sqlite::Statement get(impl_->database, "SELECT idx FROM row WHERE valid=0");
    while (get.step()) skipped.push_back(static_cast<std::uint64_t>(get.integer(0)));
  }
  if (skipped.empty()) return;
  for (const std::uint64_t index : skipped) impl_->drop(index);
  impl_->done = {};
  impl_->find_done();
}

void Journal::commit() {
  const std::lock_guard lock(impl_->mutex);
  impl_->commit();
}

void Journal::close() { impl_->close(); }

const std::filesystem::path& Journal::path() const noexcept { return impl_->database.path(); }
const std::string& Journal::identity() const noexcept { return impl_->identity; }
const IndexSet& Journal::done() const noexcept { return impl_->done; }
std::uint64_t Journal::damaged() const noexcept { return impl_->damaged; }

std::vector<Session> Journal::sessions() const {
  const std::lock_guard lock(impl_->mutex);
  impl_->commit();  // with what this one has made so far
  std::vector<Session> all;
  sqlite::Statement get(impl_->database, "SELECT text FROM session ORDER BY id");
  while (get.step()) all.push_back(session_from_json(get.text(0)));
  return all;
}

void Journal::rows(IndexRange range, bool pressure, const std::function<void(Row&&)>& take) const {
  const std::lock_guard lock(impl_->mutex);
  sqlite::Statement get(impl_->database,
                        "SELECT idx,valid,fault,vals,kept,checksum FROM row"
                        " WHERE idx>=? AND idx<? ORDER BY idx");
  get.bind(0, static_cast<std::int64_t>(range.first)).bind(1, static_cast<std::int64_t>(range.end));
  while (get.step()) {
    Row row = impl_->row_at(get);
    const bool kept = get.integer(4) != 0;
    const bool good =
        get.text(5) == checksum(row, kept) && (!kept || !pressure || impl_->add_series(row));
    if (!good) {
      const std::uint64_t index = row.index;
      get.reset();
      impl_->drop(index);
      throw RunError(path().string() + ": realisation " + std::to_string(index) +
                     " was damaged and has been thrown away; the same command makes it again");
    }
    take(std::move(row));
  }
}

void Journal::series_shapes(
    IndexRange range,
    const std::function<void(std::uint64_t, std::vector<std::size_t>&&)>& take) const {
  const std::lock_guard lock(impl_->mutex);
  sqlite::Statement get(impl_->database,
                        "SELECT idx,shape FROM series WHERE idx>=? AND idx<? ORDER BY idx");
  get.bind(0, static_cast<std::int64_t>(range.first)).bind(1, static_cast<std::int64_t>(range.end));
  while (get.step()) take(static_cast<std::uint64_t>(get.integer(0)), shape_of(get.text(1)));
}

}  // namespace asdic::study
