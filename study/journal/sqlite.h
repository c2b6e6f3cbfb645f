#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

// As much of SQLite as the journal needs. For its own .cpp files.
namespace asdic::detail::study::sqlite {

/// A connection; faults of SQLite's become RunError, or InputError where the file is damaged.
class Database {
 public:
  explicit Database(const std::filesystem::path& path);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void execute(const std::string& sql);
  void close();
  /// Gives the pages back that it has read.
  void release_memory() const noexcept;
  /// Throws for a result code that is not one of success.
  void check(int code) const;
  [[nodiscard]] sqlite3* get() const noexcept { return connection_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Whether locks keep other processes out; false where the file system has none.
  [[nodiscard]] bool locks() const noexcept { return locks_; }

 private:
  std::filesystem::path path_;
  bool locks_ = true;
  sqlite3* connection_ = nullptr;
};

/// A prepared statement; columns and parameters are counted from 0.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  // What is bound must live until the statement has run.
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::byte> blob);

  [[nodiscard]] bool step();  ///< \return whether there is a row
  void run();                 ///< to its end, and ready for the next time
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::span<const std::byte> blob(int column) const;  ///< until the next step

 private:
  const Database* database_;
  sqlite3_stmt* statement_ = nullptr;
};

}  // namespace asdic::detail::study::sqlite
