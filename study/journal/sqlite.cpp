#include "study/journal/sqlite.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <utility>

#include "core/error.h"
#include "io/files/input_file.h"
#include "io/files/output_lock.h"

namespace asdic::detail::study::sqlite {

namespace {

/// A journal is data. What else a database may bring along (views, triggers, functions in its
/// schema, links in place of the file) is not obeyed, and nothing that is read is taken to be
/// whole.
void distrust(sqlite3* connection) {
  for (const auto& [setting, on] :
       {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1}, std::pair{SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
        std::pair{SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}, std::pair{SQLITE_DBCONFIG_ENABLE_VIEW, 0}})
    sqlite3_db_config(connection, setting, on, nullptr);
  sqlite3_exec(connection, "PRAGMA cell_size_check=ON", nullptr, nullptr, nullptr);
}

}  // namespace

Database::Database(const std::filesystem::path& path) : path_(path) {
  if (std::error_code unknown; std::filesystem::exists(path, unknown))
    require_file(path, "a journal of asdic study");
  else  // an empty database, so that there is something to try a lock on
    ::close(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  locks_ = !refuses_locks(path);
  const int code =
      sqlite3_open_v2(path.c_str(), &connection_,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_FULLMUTEX,
                      locks_ ? nullptr : "unix-none");
  try {
    check(code);
  } catch (...) {
    sqlite3_close_v2(connection_);
    throw;
  }
  sqlite3_extended_result_codes(connection_, 1);
  distrust(connection_);
  sqlite3_busy_timeout(connection_, 1000);  // [ms]: another may just be ending
}

Database::~Database() { sqlite3_close_v2(connection_); }

void Database::close() {
  if (connection_ == nullptr) return;
  check(sqlite3_close(connection_));
  connection_ = nullptr;
}

void Database::release_memory() const noexcept { sqlite3_db_release_memory(connection_); }

void Database::check(int code) const {
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  const std::string said =
      connection_ != nullptr ? sqlite3_errmsg(connection_) : sqlite3_errstr(code);
  switch (code & 0xff) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw InputError({.where = path_.string(),
                        .got = "a damaged journal (" + said + ")",
                        .expected = "one as asdic study left it; remove it to begin afresh"});
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw RunError(path_.string() + ": another asdic is at work on this study");
    case SQLITE_FULL:
      throw RunError(path_.string() + ": the disk is full: writing a row failed");
    default:
      throw RunError(path_.string() + ": the journal failed: " + said);
  }
}

void Database::execute(const std::string& sql) {
  check(sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr));
}

Statement::Statement(const Database& database, const std::string& sql) : database_(&database) {
  database.check(sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &statement_, nullptr));
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::bind(int parameter, std::int64_t value) {
  database_->check(sqlite3_bind_int64(statement_, parameter + 1, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  database_->check(sqlite3_bind_text64(statement_, parameter + 1, text.data(), text.size(),
                                       SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::byte> blob) {
  database_->check(
      sqlite3_bind_blob64(statement_, parameter + 1, blob.data(), blob.size(), SQLITE_STATIC));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_);
  database_->check(code);
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) continue;
  reset();
}

void Statement::reset() { sqlite3_reset(statement_); }

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
  return text == nullptr ? std::string() : std::string(text, size);
}

std::span<const std::byte> Statement::blob(int column) const {
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(statement_, column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

}  // namespace asdic::detail::study::sqlite
