#pragma once
#include <limits>

#include "core/units.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// Eigenrays of one leg of the way.
struct Leg {
  enum class Kind { source_to_target, target_to_array, source_to_array, source_to_receiver };
  Kind kind = Kind::source_to_target;
  int target = -1;  ///< index in the scenario, −1 for source_to_array (there and back, no target)
  int array = -1;   ///< index in the scenario, −1 for legs that end elsewhere
  int channel = -1;      ///< its phone, −1 for the array's reference point
  double bearing = 0.0;  ///< direction of travel, clockwise from north [rad]
  double range = 0.0;    ///< horizontal [m]
  /// Where it ends on the map [m]; NaN where it has no bearing of its own.
  Vec2 end = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
  Arrivals arrivals;
};

}  // namespace asdic::detail
