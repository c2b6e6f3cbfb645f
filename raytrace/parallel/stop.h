#pragma once
#include <functional>
#include <stop_token>

namespace asdic::detail {

/// Does some work; when `stop` is requested meanwhile, its parallel loops
/// (raytrace/parallel/parallel.h) end early and its stop points throw, so that it is over within
/// milliseconds. \throws Interrupted if it was stopped; what the work throws
void until_stopped(const std::stop_token& stop, const std::function<void()>& work);

/// For loops that may take long beside or within the parallel ones: ends the work that was called
/// off; else costs some nanoseconds. \throws Interrupted
void stop_point();

/// stop_point() of the place where it was made, for work that does not belong to it any more: TBB
/// begins that of a collaborative_call_once() afresh, and nobody's calling off gets there.
class StopPoint {
 public:
  StopPoint() noexcept;
  void operator()() const;  ///< \throws Interrupted

 private:
  void* group_;  // tbb::task_group_context of the place; null: of none
};

}  // namespace asdic::detail
