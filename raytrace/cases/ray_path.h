#pragma once
#include <vector>

namespace asdic::detail {

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

}  // namespace asdic::detail
