#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "study/journal/journal.h"
#include "study/runs/run_study.h"

namespace asdic::detail::study::mpi {

/// Indices on their way to the threads of a rank.
class IndexQueue {
 public:
  void push(IndexRange range);
  void close();  ///< no more will come
  /// Waits for an index; none: closed and empty.
  std::optional<std::uint64_t> next();
  [[nodiscard]] std::uint64_t left();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<IndexRange> ranges_;
  bool closed_ = false;
};

/// What a rank computes, beside the thread that talks to the others: rows into its journal.
class Worker {
 public:
  Worker(const Work& work, const StudyRun& run, int rank);
  ~Worker();

  [[nodiscard]] IndexQueue& queue() noexcept { return queue_; }
  void stop();  ///< finishes the rows in hand
  /// Whether it has fewer indices left than its threads will soon ask for.
  [[nodiscard]] bool hungry();
  /// Rows that were made since the last call, without their time series.
  [[nodiscard]] std::vector<Row> new_rows();
  [[nodiscard]] bool over() const noexcept { return over_; }
  /// After over(): \throws what a realisation or the journal threw
  std::uint64_t made();

 private:
  void work_on(const Realise& realise);

  Journal journal_;
  RowsInHand hand_;
  IndexQueue queue_;
  std::size_t in_flight_;
  std::stop_source stop_;
  std::mutex mutex_;  // of rows_
  std::vector<Row> rows_;
  std::atomic<bool> over_ = false;
  std::uint64_t made_ = 0;
  std::exception_ptr fault_;
  std::thread thread_;
};

}  // namespace asdic::detail::study::mpi
