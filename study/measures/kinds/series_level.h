#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// Of what the phones of the array record as a whole.
struct SeriesLevel {
  static constexpr std::string_view name = "series_level";
  static constexpr Needs needs{.samples = true};
  static void of_ping(const MeasuredPing& ping, Collector& to);
};

}  // namespace asdic::detail::study
