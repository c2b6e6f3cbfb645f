#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "study/journal/fingerprint.h"
#include "study/sampling/index_set.h"

namespace asdic::detail::study {

/// Rows on their way into a file, safe against a crash: an SQLite database in WAL mode
/// (docs/formats/study-results.md, "the journal").
///
/// What append() took is on the disk within a second, whatever happens to the process or to the
/// machine (synchronous = FULL; a thread commits what waits for half a second). Each row carries a
/// checksum; a row that does not match it is as if it had never been made. One process at a time
/// has a journal open; the methods may be called by any thread, one at a time.
class Journal {
 public:
  /// Opens or makes it.
  /// One without rows is anybody's: it becomes this study's.
  /// \throws InputError if it holds rows of another study (both identities are told), or is
  /// damaged; RunError if another process has it, or the disk says no
  Journal(const std::filesystem::path& path, const Fingerprint& fingerprint);
  /// Opens one that exists, whatever its study.
  explicit Journal(const std::filesystem::path& path);
  ~Journal();  ///< commits; faults are lost (call close() to receive of them)
  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;

  /// From now on rows are this one's. Written again when the journal closes, with its rows and
  /// seconds.
  void begin(const Session& session);
  /// Notes a run that made rows which come from a file.
  void add(const Session& session);
  /// A row of an index that is there already replaces it.
  void append(const Row& row);
  /// Sums of the cells of rows that come from a file, which tells them no more by row.
  void import_cells(const CellSums& sums);
  [[nodiscard]] CellSums imported_cells() const;
  /// Throws the rows that were skipped away.
  void drop_skipped();
  void commit();
  void close();

  [[nodiscard]] const std::filesystem::path& path() const noexcept;
  [[nodiscard]] const std::string& identity() const noexcept;
  /// Whether other processes are kept from opening it; false where the file system has no locks.
  [[nodiscard]] bool alone() const noexcept;
  [[nodiscard]] const IndexSet& done() const noexcept;  ///< when it was opened, and since
  /// Rows that did not match their checksum when it was opened: thrown away, to be made again.
  [[nodiscard]] std::uint64_t damaged() const noexcept;
  [[nodiscard]] std::vector<Session> sessions() const;

  /// The rows of a range in the order of their indices.
  /// \param kept  with the time series and arrays that they keep
  /// \throws RunError if a row has been damaged since the journal was opened
  void rows(IndexRange range, bool kept, const std::function<void(Row&&)>& take) const;
  /// Which of them have a time series, its shape and timing: rows without values or pressure.
  void series(IndexRange range, const std::function<void(Row&&)>& take) const;
  /// One of them. \throws RunError as rows()
  [[nodiscard]] std::vector<float> pressure(std::uint64_t index) const;
  /// Which of them keep an array of a name, with its shape and head, but without values.
  void arrays(IndexRange range, std::string_view name,
              const std::function<void(std::uint64_t index, KeptArray&&)>& take) const;
  /// One of them. \throws RunError as rows()
  [[nodiscard]] KeptArray array(std::uint64_t index, std::string_view name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// OUTPUT.journal, and those of the ranks of MPI, OUTPUT.rankN.journal.
[[nodiscard]] std::filesystem::path journal_of(const std::filesystem::path& output);
[[nodiscard]] std::filesystem::path journal_of(const std::filesystem::path& output, int rank);
/// All that are there, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> journals_of(const std::filesystem::path& output);
/// Takes a journal and what SQLite keeps beside it away.
void remove_journal(const std::filesystem::path& path);

}  // namespace asdic::detail::study
