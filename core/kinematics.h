#pragma once
#include "core/units.h"

namespace asdic::detail {

/// Where something is, and how it moves.
struct Kinematics {
  Vec3 position = Vec3::Zero();  ///< [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
};

}  // namespace asdic::detail
