#pragma once
#include "core/units.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// One path along which an interfering ship is received, at the record's first sample.
struct ReceivedPath {
  int interferer = 0;            ///< index in the scenario
  int array = 0;                 ///< index in the scenario
  double delay = 0.0;            ///< since it left the ship [s]
  double doppler = 1.0;          ///< received over sent frequency
  double range = 0.0;            ///< horizontal, from where the ship was [m]
  double bearing = 0.0;          ///< direction of travel, clockwise from north [rad]
  Vec3 slowness = Vec3::Zero();  ///< at the array [s/m]
  Vec3 moveout = Vec3::Zero();  ///< ∇τ there: the slowness over 1 − s·v of the moving ship [s/m]
  Arrival path;
};

}  // namespace asdic::detail
