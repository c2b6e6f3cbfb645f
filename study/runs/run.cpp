#include "study/runs/run.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <exception>
#include <memory>

#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"

namespace asdic::detail::study {
namespace {

/// What travels through the pipeline.
struct InHand {
  std::uint64_t index = 0;
  Row row;
  bool made = false;  ///< false: called off, or at fault
  std::exception_ptr fault;
};
using Parcel = std::shared_ptr<InHand>;

/// Makes the row, unless it is called off meanwhile.
void make_row(const Realise& realise, const std::stop_token& stop, InHand& parcel) {
  try {
    until_stopped(stop, [&] { parcel.row = realise(parcel.index); });
    parcel.made = true;
  } catch (const Interrupted&) {
  }
}

}  // namespace

std::uint64_t run(const Realise& realise, const NextIndex& next, const RowSink& sink,
                  const RunOptions& options) {
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t tokens = options.in_flight > 0 ? options.in_flight : 4 * threads;
  std::atomic<bool> over = false;
  std::uint64_t done = 0;
  std::exception_ptr fault;  // of the first index at fault

  const auto draw = [&](tbb::flow_control& control) -> Parcel {
    if (!over && !options.stop.stop_requested())
      if (const auto index = next()) return std::make_shared<InHand>(InHand{.index = *index});
    control.stop();
    return {};
  };
  const auto make = [&](Parcel parcel) -> Parcel {
    try {
      // A thread that waits inside of a realisation must not begin another one meanwhile: it would
      // find its own scratch memory in use.
      tbb::this_task_arena::isolate([&] { make_row(realise, options.stop, *parcel); });
    } catch (...) {
      parcel->fault = std::current_exception();
      over = true;
    }
    return parcel;
  };
  const auto write = [&](const Parcel& parcel) {
    if (fault) return;  // nothing after it counts
    if (parcel->fault) {
      fault = parcel->fault;
      return;
    }
    if (!parcel->made) return;
    if (!sink(std::move(parcel->row))) over = true;
    ++done;
  };
  tbb::parallel_pipeline(
      tokens, tbb::make_filter<void, Parcel>(tbb::filter_mode::serial_in_order, draw) &
                  tbb::make_filter<Parcel, Parcel>(tbb::filter_mode::parallel, make) &
                  tbb::make_filter<Parcel, void>(tbb::filter_mode::serial_in_order, write));
  if (fault) std::rethrow_exception(fault);
  return done;
}

}  // namespace asdic::detail::study
