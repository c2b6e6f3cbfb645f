#pragma once
#include "core/quantity.h"
#include "raytrace/cases/ray_path.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// What a fan of rays may be asked for: half way round the Earth, and no more than can be read.
inline constexpr Quantity traced_range{.noun = "range", .unit = "m", .low = 1e-3, .high = 2e7};
inline constexpr int most_traced_rays = 100'000, most_traced_bounces = 100'000;

/// Traces one ray out to a range, with points at most `depth_step` apart in depth. It ends early
/// after `max_bounces`, or 20 000 turning points (almost along a kink). In an ocean that is not
/// layered it is marched, within 0.5 m between points, and may turn back. There it ends after
/// 40 000 segments.
[[nodiscard]] RayPath trace_ray(const Environment& environment, double source_depth,
                                double launch_elevation, double max_range, double depth_step = 50.0,
                                int max_bounces = 100);

}  // namespace asdic::detail
