#pragma once
#include <string>

namespace asdic::detail::study::mpi {

/// MPI from here to the end of the program. Its calls are made by this thread alone.
class Session {
 public:
  Session(int& argc, char**& argv);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int size() const noexcept { return size_; }
  /// Ranks on this machine; called by all of them.
  [[nodiscard]] int ranks_here() const;
  /// The lowest rank that says true; −1: none does.
  [[nodiscard]] int first_with(bool here) const;
  /// Rank 0's text.
  [[nodiscard]] std::string shared(const std::string& text) const;
  /// Ends all ranks at once.
  [[noreturn]] void abort(int status) const;

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace asdic::detail::study::mpi
