#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// Detection of each target over a run of pings: ever, first, and the beginning of a track.
struct OverPings {
  static constexpr std::string_view name = "";
  static constexpr Needs needs{};
  static bool wanted(const MeasurePlan& plan) { return plan.run.has_value(); }
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
  static void of_ping(const MeasuredPing& ping, Collector& to);
};

}  // namespace asdic::detail::study
