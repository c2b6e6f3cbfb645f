#pragma once
#include <filesystem>
#include <optional>

#include "io/files/unfinished.h"

namespace asdic::detail {

/// Whether an error number of flock or fcntl says that the file system has no locks, as is so of
/// some network file systems.
[[nodiscard]] bool says_no_locks(int error) noexcept;
/// Whether the system refuses locks on an existing file. Callers then go on without a lock.
[[nodiscard]] bool refuses_locks(const std::filesystem::path& path);

/// The right to write a result: one process at a time has it, from before the work until the result
/// has its name.
///
/// It is a lock of the system (flock) on TARGET.lock, which tells who has it and goes with it. The
/// system frees it when the process ends, however it ends; a TARGET.lock that is left is taken
/// over. Independent of HDF5's own locks. A file system without locks gives the right to everybody:
/// results are whole there too, the last one stays.
class OutputLock {
 public:
  /// \throws RunError telling process, host and since when if somebody has it, or if the folder
  /// cannot be written; InputError for a TARGET.lock that is not asdic's
  explicit OutputLock(const std::filesystem::path& target);
  ~OutputLock();
  OutputLock(OutputLock&& other) noexcept;
  OutputLock& operator=(OutputLock&&) = delete;

  /// Whether other processes are kept out; false where the file system has no locks.
  [[nodiscard]] bool alone() const noexcept { return alone_; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
  bool alone_ = true;
  std::optional<Unfinished> unfinished_{};
};

}  // namespace asdic::detail
