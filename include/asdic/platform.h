#pragma once

/// \file
/// What carries the sonar, and what sends.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.add("platform", asdic::Platform{.name = "ship", .position = {0.0, 0.0, 5.0}})
///     .add("platform", asdic::Platform{.name = "buoy", .position = {3000.0, 0.0, 40.0}})
///     .add("transmitter", asdic::Transmitter{.platform = "ship",
///                                            .source_level_db = 215.0,
///                                            .elevation_deg = -5.0,
///                                            .beamwidth_deg = 15.0});
/// std::cout << scenario.to_toml();
/// ```

#include <optional>
#include <string>
#include <vector>

#include "asdic/units.h"
#include "asdic/value.h"

namespace asdic {

/// Where something is at a time.
struct Waypoint {
  double time = 0.0;  ///< since the start of the scenario [s]
  Vector position{};  ///< east, north, depth [m]
};

struct ASDIC_API Platform {
  std::string name = {};
  Vector position{};                     ///< at the start [m]
  Vector velocity{};                     ///< [m/s]
  std::vector<Waypoint> waypoints = {};  ///< instead of both, where there are any
  operator Value() const;
};

/// A transmitter with the beam of a vertical line. Others are set by their keys
/// (`transmitter.kind`, `transmitter.projector`).
struct ASDIC_API Transmitter {
  std::string name = {};
  std::string platform = {};                 ///< its name; the first
  Vector offset{};                           ///< from the platform [m]
  double source_level_db = 0.0;              ///< [dB re 1 µPa at 1 m]
  double elevation_deg = 0.0;                ///< of the beam
  std::string taper = "hann";                ///< hann, rectangular, omnidirectional
  std::optional<double> beamwidth_deg = {};  ///< needed unless omnidirectional
  operator Value() const;
};

}  // namespace asdic
