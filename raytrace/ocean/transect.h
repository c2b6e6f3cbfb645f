#pragma once
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Where on the map the ocean's range axis lies: from an origin along a bearing. The ocean is the
/// same everywhere across it, so that range is the distance along it.
struct Transect {
  double x = 0.0, y = 0.0;  ///< of range 0 [m] east, north
  double bearing = 0.0;     ///< of growing range, clockwise from north [rad]

  /// Range of a place on the map [m].
  [[nodiscard]] double range_of(double east, double north) const noexcept;

  [[nodiscard]] bool operator==(const Transect&) const = default;
};

}  // namespace asdic::detail
