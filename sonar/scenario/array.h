#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "sonar/scenario/electronics.h"

namespace asdic::detail {

class Fields;

/// A towed line: its phones lie on the path of the tow point.
struct TowedLine {
  std::vector<double> behind;  ///< [n] along the path [m]
  double heading = 0.0;        ///< of a tow point that never moves [rad]
};

/// A hydrophone array: phones relative to where it is fixed to its platform, in the frame x east, y
/// north, z down. Its reference point is their middle (sonar/scenario/carried.h).
struct ReceiverArray {
  std::vector<Vec3> phones;    ///< [n] offsets from where it is fixed [m]
  Vec3 offset = Vec3::Zero();  ///< of that (towed: of the tow point) from the platform [m]
  std::string name = "array";
  int platform = 0;                       ///< that carries it, an index
  std::vector<std::vector<Vec3>> shapes;  ///< of each ping in turn, repeated as needed, in place of
                                          ///< `phones`; empty: it keeps its shape
  std::optional<TowedLine> towed;         ///< in place of `phones`
  Electronics electronics;

  void describe(Fields& field);
};

/// A straight line of n phones around its centre.
/// \param heading  of the line, clockwise from north [rad]; broadside is heading + 90°
/// \param pitch    of the line above the horizontal, positive up [rad]; π/2 is a vertical array
/// whose first phone is the deepest
[[nodiscard]] ReceiverArray line_array(int phones, double spacing, double heading, double pitch);

}  // namespace asdic::detail
