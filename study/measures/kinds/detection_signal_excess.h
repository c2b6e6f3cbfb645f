#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// By how much an echo is over what the receiver of [measure.detection] detects half of the time.
struct DetectionSignalExcess {
  static constexpr std::string_view name = "detection_signal_excess";
  static constexpr Needs needs{.targets = true};
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

}  // namespace asdic::detail::study
