#pragma once
#include <cmath>

#include "core/units.h"

namespace asdic::detail {

/// Where one thing lies from another, in the horizontal.
struct Separation {
  double range = 0.0;    ///< [m]
  double bearing = 0.0;  ///< clockwise from north [rad]
};

[[nodiscard]] inline Separation separation(const Vec3& from, const Vec3& to) noexcept {
  const Vec3 d = to - from;
  return {.range = std::hypot(d.x(), d.y()), .bearing = std::atan2(d.x(), d.y())};
}

/// Unit vector (x east, y north, z down) of a direction told by bearing and elevation (positive up)
/// [rad].
[[nodiscard]] inline Vec3 direction(double bearing, double elevation) noexcept {
  return {std::cos(elevation) * std::sin(bearing), std::cos(elevation) * std::cos(bearing),
          -std::sin(elevation)};
}

}  // namespace asdic::detail
