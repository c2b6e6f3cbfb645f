#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// Where each target is when the ping is sent, from the array's first phone.
struct TargetPlace {
  static constexpr std::string_view name = "target_place";
  static constexpr Needs needs{.targets = true};
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

}  // namespace asdic::detail::study
