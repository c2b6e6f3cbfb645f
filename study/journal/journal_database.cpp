// The tables of a journal, and the thread that commits what waits.
#include "study/journal/journal_database.h"

#include <condition_variable>
#include <string_view>

#include "core/error.h"
#include "study/measures/row_bytes.h"

namespace asdic::detail::study {
namespace {

constexpr std::string_view format = "asdic journal 2";
constexpr auto commit_after = std::chrono::milliseconds(500);

// Without a rowid's own tree for time series, rows stay small and quick to read through.
constexpr const char* schema =
    "CREATE TABLE IF NOT EXISTS meta(key TEXT PRIMARY KEY, value TEXT);"
    "CREATE TABLE IF NOT EXISTS session(id INTEGER PRIMARY KEY, text TEXT);"
    "CREATE TABLE IF NOT EXISTS row(idx INTEGER PRIMARY KEY, valid INTEGER, fault TEXT,"
    " vals BLOB, kept INTEGER, checksum TEXT);"
    "CREATE TABLE IF NOT EXISTS series(idx INTEGER PRIMARY KEY, shape TEXT, timing TEXT,"
    " pressure BLOB, checksum TEXT);"
    "CREATE TABLE IF NOT EXISTS cells(idx INTEGER PRIMARY KEY, counts BLOB, checksum TEXT);"
    "CREATE TABLE IF NOT EXISTS kept(idx INTEGER, name TEXT, shape TEXT, head TEXT, vals BLOB,"
    " checksum TEXT, PRIMARY KEY(idx,name));";

}  // namespace

Journal::Impl::Impl(const std::filesystem::path& path) : database(path) {
  database.execute("PRAGMA locking_mode=EXCLUSIVE");  // no shared memory: works over a network
  database.execute("PRAGMA journal_mode=WAL");
  database.execute("PRAGMA synchronous=FULL");
  database.execute("BEGIN EXCLUSIVE");
  database.execute(schema);
  database.execute("COMMIT");
}

void Journal::Impl::take_over(const Fingerprint& fingerprint) {
  database.execute("BEGIN");
  set_meta("identity", fingerprint.identity);
  set_meta("columns", to_json(fingerprint.columns));
  set_meta("study", fingerprint.text);
  set_meta("format", std::string(format));
  database.execute("COMMIT");
  identity = fingerprint.identity;
}

void Journal::Impl::check_format() {
  if (const std::string found = meta("format"); found != format)
    throw InputError({.where = database.path().string(),
                      .got = found.empty() ? "a database that is no journal" : found,
                      .expected = std::string(format)});
}

std::size_t Journal::Impl::columns_of_rows() {
  const std::string columns = meta("columns");
  try {
    return columns_from_json(columns).size();
  } catch (const std::exception& error) {
    throw InputError({.where = database.path().string(),
                      .got = std::string("columns that cannot be read (") + error.what() + ")",
                      .expected = "a journal as asdic study left it; remove it to begin afresh"});
  }
}

/// Every row is looked at once: those that do not match their checksum go.
void Journal::Impl::check_rows() {
  std::vector<std::uint64_t> bad;
  const std::size_t width = columns_of_rows();
  {
    sqlite::Statement get(
        database,
        "SELECT r.idx,r.valid,r.fault,r.vals,r.kept,r.checksum,COALESCE(s.idx,-1),c.counts,"
        "(SELECT COUNT(*) FROM kept k WHERE k.idx=r.idx)"
        " FROM row r LEFT JOIN series s ON s.idx=r.idx LEFT JOIN cells c ON c.idx=r.idx"
        " ORDER BY r.idx");
    while (get.step()) {
      const Row row = row_at(get, 7);
      const std::int64_t kept = get.integer(4);
      const bool all_there =
          (kept % 2 == 0 || get.integer(6) == get.integer(0)) && get.integer(8) == kept / 2;
      if (get.text(5) == checksum(row, kept) && all_there && get.integer(0) >= 0 &&
          row.values.size() == width)
        done.add(row.index);
      else
        bad.push_back(row.index);
    }
  }
  for (const std::uint64_t index : bad) drop(index);
  damaged = bad.size();
  sqlite::Statement imported(database, "SELECT idx FROM cells WHERE idx=-1");
  if (damaged > 0 && imported.step())
    throw RunError(
        database.path().string() +
        ": rows were damaged, and the cells of rows that came from a file cannot be told "
        "apart from theirs; --fresh begins anew");
}

Row Journal::Impl::row_at(const sqlite::Statement& get, int cells) const {
  return {.index = static_cast<std::uint64_t>(get.integer(0)),
          .valid = get.integer(1) != 0,
          .fault = get.text(2),
          .values = vector_of<double>(get.blob(3)),
          .pressure = {},
          .pressure_shape = {},
          .reuse = {},
          .cells = vector_of<std::uint8_t>(get.blob(cells))};
}

bool Journal::Impl::add_series(Row& row) const {
  sqlite::Statement get(database, "SELECT shape,timing,pressure,checksum FROM series WHERE idx=?");
  get.bind(0, static_cast<std::int64_t>(row.index));
  if (!get.step()) return false;
  const std::string shape = get.text(0);
  row.pressure_shape = shape_of(shape);
  const std::string timing = get.text(1);
  row.timing = timing_of(timing);
  row.pressure = vector_of<float>(get.blob(2));
  double samples = row.pressure_shape.empty() ? 0.0 : 1.0;
  for (const std::size_t n : row.pressure_shape) samples *= static_cast<double>(n);
  return samples == static_cast<double>(row.pressure.size()) &&
         checksum_of_series(row.index, shape, timing, get.blob(2)) == get.text(3);
}

bool Journal::Impl::add_arrays(Row& row, std::string_view name) const {
  sqlite::Statement get(database,
                        "SELECT name,shape,head,vals,checksum FROM kept WHERE idx=?1"
                        " AND (?2='' OR name=?2) ORDER BY rowid");  // as they were appended
  get.bind(0, static_cast<std::int64_t>(row.index)).bind(1, name);
  while (get.step()) {
    const std::string shape = get.text(1), head = get.text(2);
    KeptArray array{.name = get.text(0),
                    .shape = shape_of(shape),
                    .head = numbers_of(head),
                    .values = vector_of<double>(get.blob(3))};
    double numbers = array.shape.empty() ? 0.0 : 1.0;
    for (const std::size_t n : array.shape) numbers *= static_cast<double>(n);
    if (numbers != static_cast<double>(array.values.size()) ||
        checksum_of_array(row.index, array.name, shape, head, get.blob(3)) != get.text(4))
      return false;
    row.kept.push_back(std::move(array));
  }
  return name.empty() || !row.kept.empty();
}

void Journal::Impl::drop(std::uint64_t index) const {
  for (const char* sql : {"DELETE FROM row WHERE idx=?", "DELETE FROM series WHERE idx=?",
                          "DELETE FROM cells WHERE idx=?", "DELETE FROM kept WHERE idx=?"})
    sqlite::Statement(database, sql).bind(0, static_cast<std::int64_t>(index)).run();
}

void Journal::Impl::throw_away(std::uint64_t index) const {
  drop(index);
  throw RunError(database.path().string() + ": realisation " + std::to_string(index) +
                 " was damaged and has been thrown away; the same command makes it again");
}

void Journal::Impl::start() {
  check_rows();
  insert_row.emplace(database, "REPLACE INTO row VALUES(?,?,?,?,?,?)");
  insert_series.emplace(database, "REPLACE INTO series VALUES(?,?,?,?,?)");
  insert_cells.emplace(database, "REPLACE INTO cells VALUES(?,?,NULL)");
  insert_array.emplace(database, "REPLACE INTO kept VALUES(?,?,?,?,?,?)");
}

/// Only a journal that rows come into needs somebody who commits them: thousands may be open.
void Journal::Impl::begin_to_commit() {
  committer = std::jthread([this](const std::stop_token& over) {
    using Clock = std::chrono::steady_clock;
    auto last = Clock::now();
    std::mutex asleep;
    std::condition_variable_any nobody;
    while (!over.stop_requested()) {
      std::unique_lock sleep(asleep);
      nobody.wait_for(sleep, over, std::chrono::milliseconds(20), [] { return false; });
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
  if (!committer.joinable()) begin_to_commit();
  if (!pending) database.execute("BEGIN");
  pending = true;
  Row clean{.index = row.index,
            .valid = row.valid,
            .fault = row.fault,
            .values = row.values,
            .pressure = {},
            .pressure_shape = {},
            .reuse = {},
            .cells = row.cells};
  one_kind_of_nan(clean.values);
  const std::int64_t kept = kept_number(row);
  const auto index = static_cast<std::int64_t>(row.index);
  const std::string sum = checksum(clean, kept);
  insert_row->bind(0, index)
      .bind(1, std::int64_t{row.valid})
      .bind(2, row.fault)
      .bind(3, bytes_of(clean.values))
      .bind(4, kept)
      .bind(5, sum)
      .run();
  if (!row.pressure.empty()) {
    const std::string shape = shape_text(row.pressure_shape);
    const std::string timing = timing_text(row.timing);
    const std::string series_sum =
        checksum_of_series(row.index, shape, timing, bytes_of(row.pressure));
    insert_series->bind(0, index)
        .bind(1, shape)
        .bind(2, timing)
        .bind(3, bytes_of(row.pressure))
        .bind(4, series_sum)
        .run();
  }
  for (const KeptArray& array : row.kept) append_array(index, array);
  if (!row.cells.empty())
    insert_cells->bind(0, index).bind(1, std::as_bytes(std::span(clean.cells))).run();
  done.add(row.index);
  if (session) ++session->rows;
}

void Journal::Impl::append_array(std::int64_t index, KeptArray array) {
  one_kind_of_nan(array.head);
  one_kind_of_nan(array.values);
  const std::string shape = shape_text(array.shape), head = numbers_text(array.head);
  const std::string sum = checksum_of_array(static_cast<std::uint64_t>(index), array.name, shape,
                                            head, bytes_of(array.values));
  insert_array->bind(0, index)
      .bind(1, array.name)
      .bind(2, shape)
      .bind(3, head)
      .bind(4, bytes_of(array.values))
      .bind(5, sum)
      .run();
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
  insert_cells.reset();
  insert_array.reset();
  database.close();
}

}  // namespace asdic::detail::study
