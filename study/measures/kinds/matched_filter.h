#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// The matched filter at the echo's time and where there is no echo, and what a detection by it
/// says.
struct MatchedFilterAnswer {
  static constexpr std::string_view name = "snr_matched";
  static constexpr Needs needs{.targets = true, .matched_filter = true};
  static bool wanted(const MeasurePlan& plan) { return plan.uses_matched_filter(); }
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

}  // namespace asdic::detail::study
