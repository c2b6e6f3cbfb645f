#pragma once
#include <vector>

#include "raytrace/environment.h"

namespace asdic {

/// One point of a traced ray.
struct RayPoint {
  double range = 0.0;  ///< [m]
  double depth = 0.0;  ///< [m]
  double time = 0.0;   ///< [s]
};

/// A traced ray, for tables and pictures.
struct RayPath {
  double launch_elevation = 0.0;  ///< [rad], positive up
  double final_elevation = 0.0;   ///< direction of travel at the end [rad]
  double path_length = 0.0;       ///< [m]
  int surface_bounces = 0, bottom_bounces = 0, turns = 0;
  std::vector<RayPoint> points;      ///< in order; every bounce and turning point is one of them
  std::vector<double> surface_hits;  ///< ranges [m]
};

/// Traces one ray out to a range, with points at most `depth_step` apart in depth. It ends early
/// after `max_bounces`, or 20 000 turning points (almost along a kink). In an ocean that is not
/// layered it is marched, within 0.5 m between points, and may turn back.
[[nodiscard]] RayPath trace_ray(const Environment& environment, double source_depth,
                                double launch_elevation, double max_range, double depth_step = 50.0,
                                int max_bounces = 100);

}  // namespace asdic
