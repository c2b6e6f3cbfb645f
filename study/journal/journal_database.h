#pragma once
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "study/journal/journal.h"
#include "study/journal/sqlite.h"

// Inside of Journal, for its own .cpp files.
namespace asdic::detail::study {

struct Journal::Impl {
  explicit Impl(const std::filesystem::path& path);

  [[nodiscard]] std::string meta(const std::string& key) {
    sqlite::Statement get(database, "SELECT value FROM meta WHERE key=?");
    get.bind(0, key);
    return get.step() ? get.text(0) : "";
  }

  void set_meta(const std::string& key, const std::string& value) {
    sqlite::Statement(database, "REPLACE INTO meta VALUES(?,?)").bind(0, key).bind(1, value).run();
  }

  /// From now on it is this study's.
  void take_over(const Fingerprint& fingerprint);

  [[nodiscard]] std::int64_t count_rows() const {
    sqlite::Statement count(database, "SELECT COUNT(*) FROM row");
    return count.step() ? count.integer(0) : 0;
  }

  /// Which rows are there, without a look at what is in them.
  void find_done() {
    sqlite::Statement get(database, "SELECT idx FROM row ORDER BY idx");
    while (get.step()) done.add(static_cast<std::uint64_t>(get.integer(0)));
  }

  void check_format();
  [[nodiscard]] std::size_t columns_of_rows();  ///< as its meta data say
  void check_rows();
  void start();
  void begin_to_commit();
  void append(const Row& row);
  void commit();
  void close();
  void finish_session();
  /// \param cells  which column has them
  [[nodiscard]] Row row_at(const sqlite::Statement& get, int cells) const;
  [[nodiscard]] bool add_series(Row& row) const;
  /// Adds one of its arrays, or all. \return whether they are as they were written
  [[nodiscard]] bool add_arrays(Row& row, std::string_view name = "") const;
  void append_array(std::int64_t index, KeptArray array);
  [[noreturn]] void throw_away(std::uint64_t index) const;
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
  std::optional<sqlite::Statement> insert_row, insert_series, insert_cells, insert_array;
  bool pending = false;  // a transaction is open
  std::exception_ptr fault;
  std::optional<Session> session;
  std::int64_t session_id = 0;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  std::jthread committer;  // the last: it is joined before the rest goes
};

}  // namespace asdic::detail::study
