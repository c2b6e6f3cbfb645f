#pragma once
#include <cstddef>
#include <functional>

namespace asdic::detail {

/// Calls body(i) for every i of 0 … count − 1, spread over the threads.
/// \throws Interrupted when this belongs to a task group that was cancelled, such as a realisation
/// in hand when a study is stopped (study/runs/run.h): the loop ended early, and what it made is
/// half made
void in_parallel_called(std::size_t count, const std::function<void(std::size_t i)>& body);

/// The same for any body, which is not copied.
template <typename Body>
void in_parallel(std::size_t count, Body&& body) {
  in_parallel_called(count, std::ref(body));
}

/// The same in pieces of at most `most` indices: body(begin, end).
template <typename Body>
void in_parallel_chunks(std::size_t count, std::size_t most, Body&& body) {
  in_parallel((count + most - 1) / most, [&](std::size_t piece) {
    const std::size_t begin = piece * most;
    body(begin, begin + most < count ? begin + most : count);
  });
}

/// How many workers in_parallel_by_worker() may use at once.
[[nodiscard]] std::size_t most_workers();

/// Calls body(worker, i) for every i of 0 … count − 1, spread over the threads. Two calls at the
/// same time have different workers, each below most_workers(): memory can be kept by worker.
/// \throws Interrupted as above
void in_parallel_by_worker(std::size_t count,
                           const std::function<void(std::size_t worker, std::size_t i)>& body);

}  // namespace asdic::detail
