#pragma once
#include "sonar/scenario/carried.h"
#include "sonar/scenario/ping_geometry.h"

namespace asdic::detail {

/// Of sound [m/s].
[[nodiscard]] double speed_at(const Scenario& scenario, const Vec3& place);

/// An array that listens.
struct Listening {
  const Scenario& scenario;
  const ArrayMotion& motion;
  int ping = 1;            ///< of the run, counted from 1
  double ping_time = 0.0;  ///< whose shape is kept, since the start of the scenario [s]
};

/// An array that listens to a ping.
[[nodiscard]] inline Listening listening(const PingGeometry& geometry, int array) {
  return {geometry.scenario(), geometry.motion(array), geometry.ping(), geometry.time()};
}

/// A front that passes it.
struct Front {
  /// At the reference point, as Return::slowness; zero: it may come from anywhere [s/m]
  Vec3 slowness = Vec3::Zero();
  double length = 1.0;             ///< of its path to the array [m]
  double delay = 0.0;              ///< when it comes, since the ping [s]
  double duration = 0.0;           ///< of what it brings [s]
  double highest_frequency = 1e3;  ///< and its highest frequency [Hz]
};

/// How far a phone's delay can be from that of a plane wave about the array's reference point,
/// while the line keeps the shape that it has at the ping [s]:
///
///     max over phones of  d²/(2rc) + |x||c(x) − c|/(2c²) + |s·(x(t) − x(0))|,
///
/// x from the reference point, d its part across the front's way (all of it where that may be any,
/// and |x(t) − x(0)|/c then), r the path's length. The first is
/// the front's curvature, L²cos²/(8rc) at a line's ends, the second that of the ray in water whose
/// speed changes over the array, the third what a line that turns has bent since the ping.
/// Source: docs/theory/echoes.md, "Phones"
[[nodiscard]] double plane_wave_error(const Listening& here, const Front& front);
/// The same of some of its phones about a point of their own.
[[nodiscard]] double plane_wave_error(const Listening& here, const Front& front,
                                      const Carried& point, PhoneRange phones);

/// Whether that is less than a hundredth of a period (0.063 rad). Where it is not, phones are to
/// receive paths of their own.
[[nodiscard]] bool is_plane_wave(const Listening& here, const Front& front);

}  // namespace asdic::detail
