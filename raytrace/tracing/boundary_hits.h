#pragma once
#include <complex>
#include <cstdint>
#include <vector>

#include "raytrace/ocean/ground_level.h"
#include "raytrace/tracing/fan_ray.h"

namespace asdic::detail {

/// Where a ray strikes one boundary, or passes a depth of the water: the incident field, and how
/// place and time move when the ray is launched a little higher.
struct BoundaryHit {
  std::uint64_t history =
      0;  ///< shared by rays that struck the same boundaries before, and this one
  double range = 0.0, d_range = 0.0;      ///< r [m], dr/dα along the boundary [m/rad]
  double time = 0.0, d_time = 0.0;        ///< τ [s], dτ/dα [s/rad]
  double q_per_d_range = 0.0;             ///< |q|/|dr/dα|: sin(grazing)/cos(slope)
  double slowness = 0.0;                  ///< dτ/dr along the boundary [s/m]
  double grazing = 0.0;                   ///< to the reflecting tangent [rad]
  double speed = 0.0;                     ///< of the water there [m/s]
  double nepers = 0.0;                    ///< absorption so far
  double length = 0.0;                    ///< of the path so far [m]
  double mean_slowness = 0.0;             ///< r/∫c ds: of a layered sea Snell's invariant [s/m]
  double down = 0.0;                      ///< +1 where it goes down, −1 up
  std::complex<double> reflection = 1.0;  ///< of the bounces before, with all that rough ones
                                          ///< scattered about the ray
  int caustics = 0;
  int surface_bounces = 0, bottom_bounces = 0;  ///< before
};

/// The hits of a ray on one boundary or level.
struct StrikingRay {
  double angle = 0.0;         ///< launch elevation [rad]
  double source_speed = 0.0;  ///< [m/s]
  RayEnd ended = RayEnd::box;
  double widest = 0.0;  ///< greatest |q| and |dr/dα| on the way [m/rad]
  std::vector<BoundaryHit> hits;
  std::vector<LegOfRay> parts;
};

/// \param out  its memory is reused
void digest_hits(const RayTrajectory& ray, const Environment& environment, const GroundLevel& level,
                 StrikingRay& out);

}  // namespace asdic::detail
