#pragma once
#include <optional>
#include <vector>

#include "raytrace/arrivals.h"
#include "raytrace/environment.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/layered/layer.h"

namespace asdic {

/// The ends of a path through a layered ocean.
struct PathEndsInColumn {
  double source_depth = 0.0, receiver_depth = 0.0;  ///< [m]
  double range = 0.0;                               ///< between them [m]
  double frequency = 0.0;                           ///< that sets losses [Hz]
};

/// The same path after its ends have moved by metres: Newton's method for r(σ) = range on its own
/// branch, from the ray that it was, until it misses by less than 0.01 mm.
///
/// Null wherever a search might find something else: if the ray comes to turn beyond the next
/// singular ray of the fan, or nearer to it than four times its own step; if dr/dσ changes by more
/// than a third on the way (an extremum of r, where a neighbour of the same history would meet it,
/// is then at least three steps off); if it leaves the limits. docs/theory/layered-rays.md,
/// "Following a path"
[[nodiscard]] std::optional<Arrival> followed_branch(const Environment& ocean,
                                                     const std::vector<Layer>& layers,
                                                     const PathEndsInColumn& ends,
                                                     const Arrival& known,
                                                     const PathLimits& limits);

}  // namespace asdic
