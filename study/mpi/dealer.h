#pragma once
#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "study/mpi/messages.h"
#include "study/mpi/session.h"
#include "study/mpi/worker.h"
#include "study/runs/run_study.h"

namespace asdic::detail::study::mpi {

inline constexpr auto pause = std::chrono::milliseconds(1);         ///< between looks at messages
inline constexpr auto tell_every = std::chrono::milliseconds(200);  ///< rows, and progress

/// Rank 0: deals the indices, receives of the rows, works too.
class Dealer {
 public:
  Dealer(const Work& work, const StudyRun& run, const Session& session, IndexSet missing,
         OrderedEstimate& estimate, Progress progress)
      : work_(work),
        run_(run),
        session_(session),
        missing_(std::move(missing)),
        left_(missing_.size()),
        estimate_(estimate),
        progress_(std::move(progress)),
        received_(static_cast<std::size_t>(session.size()), Clock::now()) {}

  /// \return rows that all ranks made \throws what any of them threw
  std::uint64_t deal();

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<IndexRange> next_block();
  void handle(const Message& message);
  void take(std::vector<Row>&& rows);
  void stop_all();
  void check_silence() const;
  [[noreturn]] void throw_fault() const;

  const Work& work_;
  const StudyRun& run_;
  const Session& session_;
  IndexSet missing_;
  std::uint64_t left_;
  std::size_t at_ = 0;
  std::uint64_t offset_ = 0;
  OrderedEstimate& estimate_;
  Progress progress_;
  std::vector<Clock::time_point> received_;
  std::set<int> gone_, told_no_more_;
  bool stopping_ = false;
  std::uint64_t made_ = 0;
  std::string fault_;  // the first, with a letter for its kind before it
  int faulty_ = 0;
};

}  // namespace asdic::detail::study::mpi
