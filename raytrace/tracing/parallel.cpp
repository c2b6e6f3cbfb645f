#include "raytrace/tracing/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "raytrace/called_off.h"

namespace asdic::tracing {

std::size_t most_workers() {
  return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 1;
}

void parallel(int n, const std::function<void(std::size_t worker, int i)>& body) {
  // isolated: a thread that waits here takes no other work, so its worker is not taken twice
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(0, n, [&](int i) {
      body(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()), i);
    });
    leave_if_called_off();
  });
}

}  // namespace asdic::tracing
