#include "study/journal/journal.h"

#include <algorithm>
#include "core/error.h"
#include "study/journal/journal_database.h"
#include "study/measures/row_bytes.h"

#include "study/journal/journal.h"

namespace asdic::detail::study {

Journal::Journal(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {
  impl_->check_format();
  impl_->identity = impl_->meta("identity");
  impl_->start();
}

Journal::Journal(const std::filesystem::path& path, const Fingerprint& fingerprint)
    : impl_(std::make_unique<Impl>(path)) {
  if (impl_->meta("format").empty()) impl_->take_over(fingerprint);
  impl_->check_format();
  impl_->identity = impl_->meta("identity");
  if (const std::int64_t rows = impl_->count_rows();
      impl_->identity != fingerprint.identity && rows > 0)
    throw InputError(
        {.where = path.string(),
         .got = (rows == 1 ? "a realisation" : std::to_string(rows) + " realisations") +
                " of another study" + how_changed(impl_->meta("study"), fingerprint.text) +
                " (identity " + impl_->identity + ")",
         .expected = "those of this one (identity " + fingerprint.identity +
                     "): --fresh throws them away and begins anew, another -o keeps "
                     "them"});
  if (impl_->identity != fingerprint.identity) impl_->take_over(fingerprint);
  if (impl_->meta("columns") != to_json(fingerprint.columns))
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
    // whoever wants to receive of it calls close()
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

void Journal::import_cells(const CellSums& sums) {
  const std::lock_guard lock(impl_->mutex);
  impl_->commit();
  const std::vector<std::uint8_t> bytes = bytes_of(sums);
  const std::string sum = checksum_of_cells(bytes);
  sqlite::Statement(impl_->database, "REPLACE INTO cells VALUES(-1,?,?)")
      .bind(0, std::as_bytes(std::span(bytes)))
      .bind(1, sum)
      .run();
}

CellSums Journal::imported_cells() const {
  const std::lock_guard lock(impl_->mutex);
  sqlite::Statement get(impl_->database, "SELECT counts,checksum FROM cells WHERE idx=-1");
  if (!get.step()) return {};
  const auto bytes = vector_of<std::uint8_t>(get.blob(0));
  if (get.text(1) != checksum_of_cells(bytes))
    throw RunError(path().string() +
                   ": the cells of rows that came from a file were damaged; "
                   "--fresh begins anew");
  return cell_sums_of(bytes);
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
bool Journal::alone() const noexcept { return impl_->database.locks(); }
const std::string& Journal::identity() const noexcept { return impl_->identity; }
const IndexSet& Journal::done() const noexcept { return impl_->done; }
std::uint64_t Journal::damaged() const noexcept { return impl_->damaged; }

std::vector<Session> Journal::sessions() const {
  const std::lock_guard lock(impl_->mutex);
  impl_->commit();  // with what this one has made so far
  std::vector<Session> all;
  sqlite::Statement get(impl_->database, "SELECT text FROM session ORDER BY id");
  while (get.step()) try {
      all.push_back(session_from_json(get.text(0)));
    } catch (const std::exception& error) {
      throw InputError({.where = path().string(),
                        .got = std::string("a session that cannot be read (") + error.what() + ")",
                        .expected = "a journal as asdic study left it"});
    }
  return all;
}

void Journal::rows(IndexRange range, bool with_kept, const std::function<void(Row&&)>& take) const {
  const std::lock_guard lock(impl_->mutex);
  sqlite::Statement get(impl_->database,
                        "SELECT r.idx,valid,fault,vals,kept,r.checksum,counts FROM row r"
                        " LEFT JOIN cells c ON c.idx=r.idx"
                        " WHERE r.idx>=? AND r.idx<? ORDER BY r.idx");
  get.bind(0, static_cast<std::int64_t>(range.first)).bind(1, static_cast<std::int64_t>(range.end));
  while (get.step()) {
    Row row = impl_->row_at(get, 6);
    const std::int64_t kept = get.integer(4);
    const bool good = get.text(5) == checksum(row, kept) &&
                      (!with_kept || ((kept % 2 == 0 || impl_->add_series(row)) &&
                                      (kept < 2 || impl_->add_arrays(row))));
    if (!good) {
      const std::uint64_t index = row.index;
      get.reset();
      impl_->throw_away(index);
    }
    take(std::move(row));
  }
  get.reset();
  impl_->database.release_memory();  // thousands of journals may be read in turn
}

void Journal::series(IndexRange range, const std::function<void(Row&&)>& take) const {
  const std::lock_guard lock(impl_->mutex);
  sqlite::Statement get(impl_->database,
                        "SELECT idx,shape,timing FROM series WHERE idx>=? AND idx<? ORDER BY idx");
  get.bind(0, static_cast<std::int64_t>(range.first)).bind(1, static_cast<std::int64_t>(range.end));
  while (get.step()) {
    Row row{.index = static_cast<std::uint64_t>(get.integer(0))};
    row.pressure_shape = shape_of(get.text(1));
    row.timing = timing_of(get.text(2));
    take(std::move(row));
  }
}

std::vector<float> Journal::pressure(std::uint64_t index) const {
  const std::lock_guard lock(impl_->mutex);
  Row row{.index = index};
  if (!impl_->add_series(row)) impl_->throw_away(index);
  return std::move(row.pressure);
}

void Journal::arrays(IndexRange range, std::string_view name,
                     const std::function<void(std::uint64_t, KeptArray&&)>& take) const {
  const std::lock_guard lock(impl_->mutex);
  const std::string wanted(name);
  sqlite::Statement get(
      impl_->database,
      "SELECT idx,shape,head FROM kept WHERE idx>=? AND idx<? AND name=? ORDER BY idx");
  get.bind(0, static_cast<std::int64_t>(range.first))
      .bind(1, static_cast<std::int64_t>(range.end))
      .bind(2, wanted);
  while (get.step()) {
    const auto index = static_cast<std::uint64_t>(get.integer(0));
    KeptArray array{
        .name = wanted, .shape = shape_of(get.text(1)), .head = numbers_of(get.text(2))};
    if (array.shape.size() != 2) {
      get.reset();
      impl_->throw_away(index);
    }
    take(index, std::move(array));
  }
}

KeptArray Journal::array(std::uint64_t index, std::string_view name) const {
  const std::lock_guard lock(impl_->mutex);
  Row row{.index = index};
  if (!impl_->add_arrays(row, name)) impl_->throw_away(index);
  return std::move(row.kept.front());
}

// Where journals lie beside a study's file.

std::filesystem::path journal_of(const std::filesystem::path& output) {
  return output.string() + ".journal";
}

std::filesystem::path journal_of(const std::filesystem::path& output, int rank) {
  return output.string() + ".rank" + std::to_string(rank) + ".journal";
}

std::vector<std::filesystem::path> journals_of(const std::filesystem::path& output) {
  std::vector<std::filesystem::path> found;
  const std::string stem = output.filename().string() + ".";
  const auto folder = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(stem) || !name.ends_with(".journal")) continue;
    const std::string middle = name.substr(stem.size() - 1, name.size() - stem.size() - 7);
    if (middle.empty() || middle.starts_with(".rank")) found.push_back(output.parent_path() / name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void remove_journal(const std::filesystem::path& path) {
  std::error_code ignored;
  for (const char* suffix : {"-wal", "-shm", "-hand", ""})
    std::filesystem::remove(path.string() + suffix, ignored);
}

}  // namespace asdic::detail::study
