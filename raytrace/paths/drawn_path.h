#pragma once
#include <cstddef>

#include "raytrace/cases/ray_path.h"
#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::detail {

/// A marched ray as points: straight lines between them stay within `sagitta` of it [m].
/// \param length  where it ends, along the ray [m]   \param depth_step  greatest difference of
/// depth between two points [m]
[[nodiscard]] RayPath drawn_path(const RayTrajectory& ray, double length = 1e300,
                                 double sagitta = 0.05, double depth_step = 1e300);

}  // namespace asdic::detail
