#pragma once

/// \file
/// Rays: where sound of a launch elevation goes.
///
/// ```cpp
/// const asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// const asdic::Fan fan{.lowest = asdic::radians(-10.0), .highest = asdic::radians(10.0),
///                      .count = 21, .range = 60e3};
/// for (const asdic::Ray& ray : asdic::rays(scenario, fan))
///   std::cout << asdic::degrees(ray.launch_elevation) << " deg: " << ray.range.back() << " m, "
///             << ray.depth.back() << " m after " << ray.time.back() << " s\n";
/// ```

#include <optional>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"
#include "asdic/units.h"
#include "asdic/watch.h"

namespace asdic {

/// Which rays.
struct Fan {
  double lowest = -0.3490658503988659;      ///< launch elevation, positive up [rad]: −20 degrees
  double highest = 0.3490658503988659;      ///< [rad]
  int count = 41;                           ///< evenly between, both ends included
  std::vector<double> elevations = {};      ///< exactly these instead [rad]
  double range = 50e3;                      ///< how far [m]
  std::optional<double> source_depth = {};  ///< [m]; the platform's, or the run's
  int bounces = 100;                        ///< a ray ends after so many
};

/// One ray as a line, with a point at every bounce and turning point.
struct Ray {
  double launch_elevation = 0.0;  ///< [rad]
  double final_elevation = 0.0;   ///< direction of travel at the end [rad]
  double path_length = 0.0;       ///< [m]
  int surface_bounces = 0, bottom_bounces = 0, turns = 0;
  std::vector<double> range{};  ///< [points] [m]
  std::vector<double> depth{};  ///< [points] [m]
  std::vector<double> time{};   ///< [points] [s]
  /// [points] on the Earth [degrees]; empty where they are not known
  std::vector<double> latitude{}, longitude{};
};

/// Traces them along the scenario's transect. \return [count] in the order of the fan
/// \throws InputError for a source out of the water, elevations of 90 degrees; Stopped
[[nodiscard]] ASDIC_API std::vector<Ray> rays(const Scenario& scenario, const Fan& fan = {},
                                              const Watch& watch = {});

}  // namespace asdic
