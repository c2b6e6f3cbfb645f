#include "raytrace/ocean/speed_extremes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace asdic::detail {

SpeedExtremes speed_extremes(const SoundSpeedProfile& water, double top, double bottom) noexcept {
  SpeedExtremes found{.slowest = std::numeric_limits<double>::infinity(), .fastest = 0.0};
  const auto look = [&](double depth) {
    const double c = water.at(depth).c;
    found.slowest = std::min(found.slowest, c);
    found.fastest = std::max(found.fastest, c);
  };
  constexpr int parts = 16;  // for laws without samples
  for (int i = 0; i <= parts; ++i) look(std::lerp(top, bottom, double(i) / parts));
  for (const double depth : water.depths())
    if (depth > top && depth < bottom) look(depth);
  return found;
}

}  // namespace asdic::detail
