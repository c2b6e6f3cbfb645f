#pragma once
#include <string>
#include <vector>

#include "core/units.h"

namespace asdic {

/// A hydrophone array: phones relative to the array's reference point, in the frame x east, y
/// north, z down.
struct ReceiverArray {
  std::vector<Vec3> phones;    ///< [n] offsets from the reference point [m]
  Vec3 offset = Vec3::Zero();  ///< of the reference point from the platform [m]
  std::string name = "array";
  int platform = 0;  ///< that carries it, an index
};

/// A straight line of n phones around its centre.
/// \param heading  of the line, clockwise from north [rad]; broadside is heading + 90°
/// \param pitch    of the line above the horizontal, positive up [rad]; π/2 is a vertical array
/// whose first phone is the deepest
[[nodiscard]] ReceiverArray line_array(int phones, double spacing, double heading, double pitch);

}  // namespace asdic
