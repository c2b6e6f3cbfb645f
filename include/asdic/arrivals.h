#pragma once

/// \file
/// Eigenrays: every path that sound takes from the source to a receiver, to the targets and back.
///
/// ```cpp
/// const asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// for (const asdic::Arrival& path : asdic::arrivals(scenario, {.range = 25e3, .depth = 125.0}))
///   std::cout << path.delay << " s, " << path.level_db() << " dB, " << path.surface_bounces
///             << " times off the surface\n";
/// for (const asdic::Leg& leg : asdic::legs(scenario))
///   std::cout << "target " << leg.target << ": " << leg.arrivals.size() << " paths\n";
/// ```

#include <complex>
#include <limits>
#include <optional>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"
#include "asdic/watch.h"

namespace asdic {

/// One meeting of a path with a boundary.
struct Bounce {
  bool bottom = false;   ///< else the surface
  double grazing = 0.0;  ///< angle between path and boundary [rad]
  double range = 0.0;    ///< from the source, horizontal [m]
};

/// One eigenray. Elevations are of the direction of travel, positive up. The pressure of the path
/// is Re{amplitude · s₊(t − delay)}, of a source of 1 Pa at 1 m; time dependence e^{+iωt}.
struct ASDIC_API Arrival {
  enum class Kind { ray, diffracted, caustic };
  Kind kind = Kind::ray;
  double launch_elevation = 0.0;   ///< [rad]
  double arrival_elevation = 0.0;  ///< [rad]
  /// Of travel where it leaves and where it arrives, clockwise from the straight line on the map;
  /// 0 where rays keep to vertical planes [rad]
  double launch_deflection = 0.0, arrival_deflection = 0.0;
  double delay = 0.0;                     ///< [s]
  std::complex<double> amplitude = 0.0;   ///< all losses in it, re 1 m
  double spreading = 0.0;                 ///< |amplitude| of the ray tube alone, re 1 m
  std::complex<double> reflection = 1.0;  ///< product of the boundaries' coefficients
  double scattered = 0.0;                 ///< mean intensity beside |amplitude|², re 1 m
  double absorption_db = 0.0;             ///< along the path [dB]
  double path_length = 0.0;               ///< [m]
  int surface_bounces = 0, bottom_bounces = 0;
  int upper_turns = 0, lower_turns = 0;  ///< turning points in the water
  int caustics = 0;                      ///< passed
  std::vector<Bounce> bounces = {};      ///< in the order in which they happen

  /// 20·log₁₀|amplitude|: re the pressure at 1 m, the negative of the transmission loss [dB]
  [[nodiscard]] double level_db() const noexcept;
};

/// A receiver to ask about.
struct Receiver {
  double range = 0.0;                       ///< horizontal, from the source, from 0 [m]
  double depth = 0.0;                       ///< [m]
  std::optional<double> source_depth = {};  ///< [m]; the transmitter's
  std::optional<double> bearing = {};       ///< true [rad]; along the transect, or north
  std::optional<double> frequency = {};     ///< at which losses are told [Hz]; the pulse's centre
  int ping = 1;                             ///< when: from where it is sent, counted from 1
};

/// Eigenrays to a receiver, sorted by delay; none where no sound comes.
///
/// Nearer to the vertical than 0.1 m, paths are found at a range of 0.1 m and put upright: angles
/// and places are those of the range asked for, length, delay and amplitude those of 0.1 m. A path
/// of length h is then told (0.1 m)²/(2h) too long, 0.05 mm of 100 m. A receiver at the source has
/// a direct path of 0.1 m.
///
/// \param scenario  with a sonar. Of one with a [run] alone: source and frequency are the run's,
/// there is no bearing, and ping is 1
///
/// \throws InputError naming the argument, "receiver.range", for what is no number or lies out of
/// the water; Stopped
[[nodiscard]] ASDIC_API std::vector<Arrival> arrivals(const Scenario& scenario,
                                                      const Receiver& receiver,
                                                      const Watch& watch = {});

/// Eigenrays from the transmitter to a target, or from a target to an array.
struct Leg {
  enum class Kind { source_to_target, target_to_array };
  Kind kind = Kind::source_to_target;
  int target = 0;        ///< in the scenario, from 0
  int array = -1;        ///< in the scenario, from 0; −1 on the way out
  double bearing = 0.0;  ///< of travel, true [rad]
  double range = 0.0;    ///< horizontal [m]
  std::vector<Arrival> arrivals = {};
  /// Of its end on the Earth [degrees]; NaN where that is not known.
  double latitude = std::numeric_limits<double>::quiet_NaN();
  double longitude = std::numeric_limits<double>::quiet_NaN();
};

/// The ways out and home of one ping. \param ping  from 1
[[nodiscard]] ASDIC_API std::vector<Leg> legs(const Scenario& scenario, int ping = 1,
                                              const Watch& watch = {});

}  // namespace asdic
