#pragma once
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// How far the phase of each ray is off by its turns beside corners of the profile: a corner h from
/// the turn sends back some ¼(h/L)^{−3/2} of it, L = (c/2k²|c′|)^{1/3} Airy's length, times its
/// share of the gradient. Surface and floor are such corners, too, for rays that turn or graze
/// beside them, if `boundaries` says so. 0 for `diffracted` arrivals.
/// \return [rays, rad]
[[nodiscard]] std::vector<double> corner_errors(const Environment& ocean, double frequency,
                                                const Arrivals& rays, bool boundaries);

/// How far the amplitude of a ray may be off, as a share of it.
struct RayError {
  double focusing = 0.0;  ///< in size and phase: focusing_errors()
  double turning = 0.0;   ///< in phase: corner_errors()
};

/// Of rays too faint to matter by their corners alone; of pairs that are mended at a caustic, 10 %
/// by focusing at most. \param solver  layered()   \return [rays]
[[nodiscard]] std::vector<RayError> ray_errors(const EigenraySolver& solver, double source_depth,
                                               double receiver_depth, double frequency,
                                               const PathLimits& limits, const Arrivals& rays);

}  // namespace asdic::detail
