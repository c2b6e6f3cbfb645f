#pragma once
#include <span>
#include <vector>

#include "raytrace/tracing/cell_hits.h"

namespace asdic::detail {

/// The paths of one fan of marched rays to the cells of several levels: for means over cells.
///
/// Where hits_on_cells() splits its fan until neighbours tell each path between them, this one has
/// as many rays as asked for, twice denser about the horizontal; every ray serves all levels. Where
/// two neighbours struck the same facets their cubics are used, where these are tame; where they
/// struck other facets of the same boundaries, as often, the tube between them fills its chord. So
/// a sum of energy over some cells is right where single paths are not. \param rays  at least 16
/// \return [levels]
[[nodiscard]] std::vector<std::vector<CellHit>> hits_on_levels(
    const RayTracer& tracer, double source_depth, std::span<const GroundLevel> levels,
    const GroundGrid& cells, double max_range, double frequency, const FanLimits& limits, int rays);

}  // namespace asdic::detail
