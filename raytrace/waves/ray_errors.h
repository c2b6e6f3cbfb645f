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

/// The wavenumbers about a ray's that make its Fresnel zone, (2/r′)^{1/2} with r(ξ) the range of
/// rays [1/m]. \param wavenumber  of the source's depth [1/m]
[[nodiscard]] double fresnel_zone(const Arrival& ray, double wavenumber) noexcept;

/// Estimates the error of rays that have the boundaries' reflection of plane waves. F(ξ) is the
/// product of a ray's reflections over the wavenumber, r(ξ) the range of rays, and the next order
/// of stationary phase ½F″/r′, by differences over fresnel_zone(), so that a critical angle nearby
/// counts by what it does there. It may exceed the ray itself where that is faint.
/// \param ocean  as it is at the source; its roughness does not count
/// \return [rays] of the amplitude
[[nodiscard]] std::vector<double> reflection_errors(const Environment& ocean, double source_depth,
                                                    double frequency, const Arrivals& rays);

/// How far the amplitude of a ray may be off, as a share of it.
struct RayError {
  double focusing = 0.0;    ///< in size and phase: focusing_errors()
  double turning = 0.0;     ///< in phase: corner_errors()
  double reflecting = 0.0;  ///< in size and phase: reflection_errors()
};

/// Of rays too faint to matter by their corners alone; of pairs that are mended at a caustic, 10 %
/// by focusing at most. \param solver  layered()   \return [rays]
[[nodiscard]] std::vector<RayError> ray_errors(const EigenraySolver& solver, double source_depth,
                                               double receiver_depth, double frequency,
                                               const PathLimits& limits, const Arrivals& rays);

}  // namespace asdic::detail
