#pragma once
#include <optional>
#include <vector>

#include "core/kinematics.h"
#include "core/units.h"

namespace asdic::detail {

class Fields;

struct Waypoint {
  double time = 0.0;  ///< since the start of the scenario [s]
  Vec3 position = Vec3::Zero();

  /// \param before  the waypoint before it: later one by one, no faster than any vessel
  void describe(Fields& field, const Waypoint* before);
};

/// Where something is at a time: from a start with a constant velocity, or straight from waypoint
/// to waypoint (at rest before the first and after the last).
struct Track {
  Kinematics start;                 ///< used when there are no waypoints
  std::vector<Waypoint> waypoints;  ///< strictly increasing in time

  /// Of the table that holds the thing: `waypoints`, or `position` and `velocity`.
  /// \param is_live  a running server takes changes of them
  void describe(Fields& field, bool is_live = false);
  void describe_waypoints(Fields& field, bool is_live);  ///< the first alone

  [[nodiscard]] Kinematics at(double time) const;

  /// Of something that is carried along `offset` away [m], its clock beginning at `time` [s].
  [[nodiscard]] Track since(double time, const Vec3& offset) const;

  /// Bearing of its horizontal motion [rad]: at rest before the first waypoint the one it will
  /// take, after the last (or between two in one place) the one it took. None if it never moves.
  [[nodiscard]] std::optional<double> course_at(double time) const;
};

}  // namespace asdic::detail
