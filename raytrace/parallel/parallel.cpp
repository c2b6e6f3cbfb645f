#include "raytrace/parallel/parallel.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include "raytrace/parallel/progress.h"
#include "raytrace/parallel/stop.h"

namespace asdic::detail {

void in_parallel_called(std::size_t count, const std::function<void(std::size_t i)>& body) {
  // A task may be many indices long, and is not cut short by itself.
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (!tbb::is_current_task_group_canceling()) body(i);
  });
  // In a task whose group was cancelled the loop ended early, without a word.
  stop_point();
}

std::size_t most_workers() {
  return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 1;
}

void in_parallel_by_worker(std::size_t count,
                           const std::function<void(std::size_t worker, std::size_t i)>& body) {
  // isolated: a thread that waits here takes no other work, so its worker is not taken twice
  tbb::this_task_arena::isolate([&] {
    in_parallel(count, [&](std::size_t i) {
      body(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()), i);
    });
  });
}

void stop_point() {
  if (tbb::is_current_task_group_canceling()) throw Interrupted();
}

StopPoint::StopPoint() noexcept : group_(tbb::task::current_context()) {}

void StopPoint::operator()() const {
  auto* const group = static_cast<tbb::task_group_context*>(group_);
  if (group != nullptr && group->is_group_execution_cancelled()) throw Interrupted();
}

void until_stopped(const std::stop_token& stop, const std::function<void()>& work) {
  tbb::task_group group;
  const std::stop_callback call_off(stop, [&group] { group.cancel(); });
  // A group forgets a cancellation that came before its first task, when it takes its parent's
  // state.
  const auto unless_stopped = [&] {
    if (stop.stop_requested()) throw Interrupted();
    work();
  };
  // What the work throws when it is called off goes no further than the group.
  if (group.run_and_wait(unless_stopped) == tbb::canceled) throw Interrupted();
}

}  // namespace asdic::detail
