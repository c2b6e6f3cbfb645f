#pragma once
#include <complex>
#include <cstdint>
#include <vector>

#include "raytrace/ocean/ground_grid.h"
#include "raytrace/tracing/boundary_hits.h"
#include "raytrace/tracing/marching_eigenrays.h"

namespace asdic::detail {

/// One path to the middle of a cell of a level, of a grid around the source.
struct CellHit {
  std::uint32_t cell = 0;
  double launch_elevation = 0.0, delay = 0.0, grazing = 0.0, slowness = 0.0;
  double length = 0.0, down = 0.0;  // as of a BoundaryHit
  std::complex<double> amplitude = 0.0;
  int surface_bounces = 0, bottom_bounces = 0;  ///< before
};

/// Every path of a fan of marched rays to every cell, interpolated between neighbours that struck
/// the same boundaries and passed the level as often; range is right to a hundredth of a cell.
/// Near a caustic the amplitude is held as in boundary_paths.h. \param grid  without fine cells
/// \param max_range [m]   \param watch  see SearchWatch
[[nodiscard]] std::vector<CellHit> hits_on_cells(const RayTracer& tracer, double source_depth,
                                                 const GroundLevel& level, const GroundGrid& grid,
                                                 double max_range, double frequency,
                                                 const FanLimits& limits,
                                                 SearchWatch* watch = nullptr);

}  // namespace asdic::detail
