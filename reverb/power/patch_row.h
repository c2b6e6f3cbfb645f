#pragma once
#include <limits>

#include "core/units.h"

namespace asdic::detail {

/// What scatters back from one ground cell, by one path pair: from the whole ring in a layered
/// ocean, otherwise from the sector at `bearing` and the one mirrored about the transect.
struct PatchRow {
  enum class Ground { surface, bottom, volume };
  Ground ground = Ground::surface;  ///< what scatters
  double bearing = 0.0;             ///< of the sector, clockwise from north [rad]; NaN: whole ring
  double range = 0.0;               ///< of the cell's centre from the source [m]
  /// That centre on the map; NaN: whole ring [m].
  Vec2 place = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
  double area = 0.0;              ///< of the ring, or of the sectors [m²]
  double delay = 0.0;             ///< two-way [s]
  double grazing_in = 0.0;        ///< [rad]
  double grazing_out = 0.0;       ///< [rad]
  double launch_elevation = 0.0;  ///< of the outgoing path [rad]
  double arrival_elevation =
      0.0;  ///< of the returning path at the array, direction of travel [rad]
  double scattering_strength_db = 0.0;  ///< of that pair of angles [dB]
  double level_db =
      0.0;  ///< expected level of that area by this pair, pulse not windowed [dB re 1 µPa]
};

}  // namespace asdic::detail
