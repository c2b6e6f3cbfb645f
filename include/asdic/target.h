#pragma once

/// \file
/// What answers.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.add("target", asdic::Target{.name = "mine",
///                                      .position = asdic::Vector{4000.0, 1000.0, 80.0},
///                                      .strength_db = -15.0});
/// asdic::Target submarine{.name = "submarine", .range = 9000.0, .depth = 120.0};
/// submarine.velocity = {0.0, 4.0, 0.0};
/// submarine.aspect = asdic::Aspect{.bow_db = 5.0, .beam_db = 20.0, .stern_db = 3.0};
/// scenario.add("target", submarine);
/// std::cout << scenario.to_toml();
/// ```

#include <optional>
#include <string>
#include <vector>

#include "asdic/platform.h"
#include "asdic/units.h"
#include "asdic/value.h"

namespace asdic {

/// Strength over the angle from the bow: three numbers, straight in dB between.
struct ASDIC_API Aspect {
  double bow_db = 0.0, beam_db = 0.0, stern_db = 0.0;
  operator Value() const;
};

/// One of the places that an extended target answers from.
struct ASDIC_API Highlight {
  Vector offset{};  ///< forward, starboard, down of the target's position [m]
  std::optional<double> strength_db = {};  ///< or
  std::optional<Aspect> aspect = {};
  operator Value() const;
};

struct ASDIC_API Target {
  std::string name = {};
  std::optional<Vector> position = {};  ///< at the start [m]; or
  std::optional<double> range = {};     ///< seen from the platform's start [m], with
  double bearing_deg = 0.0;             ///< true, and
  std::optional<double> depth = {};     ///< [m]; or
  std::vector<Waypoint> waypoints = {};
  Vector velocity{};                       ///< [m/s]; not with waypoints
  std::optional<double> strength_db = {};  ///< the same from all sides; or
  std::optional<Aspect> aspect = {};       ///< or
  std::vector<Highlight> highlights = {};
  std::optional<double> heading_deg = {};  ///< true, of one that never moves
  std::string fluctuation = {};            ///< swerling-1 … swerling-4
  std::optional<int> scan_pings = {};      ///< that share a draw of swerling-1 and 3
  operator Value() const;
};

}  // namespace asdic
