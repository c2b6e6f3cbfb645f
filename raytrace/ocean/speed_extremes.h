#pragma once
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Least and greatest sound speed of a column of water [m/s].
struct SpeedExtremes {
  double slowest = 0.0, fastest = 0.0;
};

/// Extremes of the profile between two depths [m], at its nodes and at 17 depths between.
[[nodiscard]] SpeedExtremes speed_extremes(const SoundSpeedProfile& water, double top,
                                           double bottom) noexcept;

}  // namespace asdic::detail
