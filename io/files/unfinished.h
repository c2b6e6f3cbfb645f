#pragma once
#include <filesystem>

namespace asdic::detail {

/// The name of a file of this process that is of no use until it is whole: a part, a lock. While it
/// lives, a signal that ends the program takes the file away (remove_unfinished()).
class Unfinished {
 public:
  explicit Unfinished(const std::filesystem::path& path) noexcept;
  ~Unfinished();
  Unfinished(Unfinished&& other) noexcept;
  Unfinished& operator=(Unfinished&&) = delete;

 private:
  int slot_;  ///< in the table of names; -1: none
};

/// Removes all of them. For handlers of signals that end the program: it allocates nothing and
/// takes no lock.
void remove_unfinished() noexcept;

}  // namespace asdic::detail
