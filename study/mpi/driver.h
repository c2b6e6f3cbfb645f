#pragma once
#include <memory>
#include <string>

#include "study/run_study.h"

// Studies over MPI: the only place that knows it. docs/formats/study-results.md, "How a run goes"
namespace asdic::study::mpi {

/// MPI from here to the end of the program. Its calls are made by this thread alone.
class Session {
 public:
  Session(int& argc, char**& argv);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int size() const noexcept { return size_; }
  /// The lowest rank that says true; −1: none does.
  [[nodiscard]] int first_with(bool here) const;
  /// Rank 0's text.
  [[nodiscard]] std::string shared(const std::string& text) const;
  /// Ends all ranks at once.
  [[noreturn]] void abort(int status) const;

 private:
  int rank_ = 0, size_ = 1;
};

/// run_study() by all ranks together. Rank 0 deals blocks of indices to whoever has few left
/// (itself too), so that uneven work balances; each rank writes a journal of its own beside the
/// output; rank 0 makes the file of all of them. Interrupted or killed, the journals stay, and any
/// number of ranks, or `asdic study`, go on from there.
/// \return at rank 0 what came of it; at others what they made
/// \throws InputError, RunError; at rank 0 what another rank threw, too
StudyOutcome run_study(const Work& work, const StudyRun& run, const Session& session);

}  // namespace asdic::study::mpi
