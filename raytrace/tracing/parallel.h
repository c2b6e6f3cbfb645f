#pragma once
#include <cstddef>
#include <functional>

namespace asdic::tracing {

/// How many workers parallel() may use at once.
[[nodiscard]] std::size_t most_workers();

/// Calls body(worker, i) for every i in 0..n − 1, spread over the threads. Two calls at the same
/// time have different workers, each below most_workers(): memory can be kept by worker.
void parallel(int n, const std::function<void(std::size_t worker, int i)>& body);

}  // namespace asdic::tracing
