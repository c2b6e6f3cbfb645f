#pragma once
#include "raytrace/bellhop_emulation/boundary_line.h"
#include "raytrace/bellhop_emulation/literal_ray.h"
#include "raytrace/bellhop_emulation/water.h"

namespace asdic::detail::bellhop_emulation {

/// All that rays are traced through.
struct LiteralOcean {
  LiteralWater water;
  BoundaryLine surface, bottom;
  double frequency = 0.0;                   ///< [Hz]
  double step = 0.0;                        ///< longest step [m]
  double box_range = 0.0, box_depth = 0.0;  ///< [m]
  bool displacement = false;                ///< beams are carried along boundaries
};

/// Where a ray is: cell of the water, segments of the boundaries.
struct RayPlace {
  WaterCell cell;
  std::size_t surface = 0, bottom = 0;
};

/// What a step has landed on.
enum class Landing { water, surface, bottom };

/// One step of the modified polygon (midpoint) method, second order: half an Euler step, then a
/// whole step with a mean of the derivatives at its beginning and its middle. Both are cut to end
/// on the next node of the water, node of a boundary, boundary or side of the box; `place.cell`
/// moves along. \return where the step ended; p has the jump of a change of cell
LiteralPoint step(const LiteralOcean& ocean, const LiteralPoint& from, RayPlace& place,
                  Landing& landing) noexcept;

}  // namespace asdic::detail::bellhop_emulation
