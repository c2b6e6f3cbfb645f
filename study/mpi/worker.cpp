#include "study/mpi/worker.h"

#include <tbb/task_arena.h>

namespace asdic::detail::study::mpi {

void IndexQueue::push(IndexRange range) {
  const std::lock_guard lock(mutex_);
  ranges_.push_back(range);
  changed_.notify_all();
}

void IndexQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

std::optional<std::uint64_t> IndexQueue::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return closed_ || !ranges_.empty(); });
  if (ranges_.empty()) return {};
  const std::uint64_t index = ranges_.front().first++;
  if (ranges_.front().empty()) ranges_.pop_front();
  return index;
}

std::uint64_t IndexQueue::left() {
  const std::lock_guard lock(mutex_);
  std::uint64_t total = 0;
  for (const IndexRange& range : ranges_) total += range.size();
  return total;
}

Worker::Worker(const Work& work, const StudyRun& run, int rank)
    : journal_(journal_of(run.output, rank), work.fingerprint),
      hand_(journal_.path()),
      in_flight_(work.in_flight > 0
                     ? work.in_flight
                     : 4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())) {
  journal_.begin(run.session);
  thread_ = std::thread([this, realise = marked(work.realise, hand_)] { work_on(realise); });
}

Worker::~Worker() {
  stop();
  thread_.join();
}

void Worker::work_on(const Realise& realise) {
  try {
    made_ = study::run(
        realise, [this] { return queue_.next(); },
        [this](Row&& row) {
          journal_.append(row);
          row.pressure = {};
          row.kept = {};
          const std::lock_guard lock(mutex_);
          rows_.push_back(std::move(row));
          return true;
        },
        {.stop = stop_.get_token(), .in_flight = in_flight_});
    journal_.close();
  } catch (...) {
    fault_ = std::current_exception();
    try {
      journal_.close();
    } catch (const std::exception&) {
      // the first fault is the one to tell
    }
  }
  over_ = true;
}

void Worker::stop() {
  hand_.call_off();
  stop_.request_stop();
  queue_.close();
}

bool Worker::hungry() { return queue_.left() < in_flight_; }

std::vector<Row> Worker::new_rows() {
  const std::lock_guard lock(mutex_);
  return std::exchange(rows_, {});
}

std::uint64_t Worker::made() {
  if (fault_) std::rethrow_exception(fault_);
  return made_;
}

}  // namespace asdic::detail::study::mpi
