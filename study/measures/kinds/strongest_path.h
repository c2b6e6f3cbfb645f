#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// Delay, level, Doppler factor and angle of the loudest pair of paths to the array.
struct StrongestPath {
  static constexpr std::string_view name = "strongest_path";
  static constexpr Needs needs{.targets = true};
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

}  // namespace asdic::detail::study
