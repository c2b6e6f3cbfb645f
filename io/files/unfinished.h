#pragma once
#include <filesystem>

namespace asdic::detail {

/// The name of a file of this process that is useless until it is complete, such as a part or a
/// lock. While the object lives, a signal that ends the program removes the file
/// (remove_unfinished()).
class Unfinished {
 public:
  explicit Unfinished(const std::filesystem::path& path) noexcept;
  ~Unfinished();
  Unfinished(Unfinished&& other) noexcept;
  Unfinished& operator=(Unfinished&&) = delete;

 private:
  int slot_;  ///< in the table of names; -1: none
};

/// Removes the files of all Unfinished objects. Safe in a signal handler, as it allocates nothing
/// and takes no lock.
void remove_unfinished() noexcept;

}  // namespace asdic::detail
