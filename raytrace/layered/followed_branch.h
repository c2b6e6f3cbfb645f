#pragma once
#include <optional>

#include "raytrace/layered/branch_table.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// The water between two depths, for the paths between them.
struct WaterBetween {
  double source_depth, receiver_depth;  ///< [m]
  Column column;
  std::optional<OceanLegs> legs;  ///< out of the ocean's series, if it has them

  /// \param kept  of the ocean
  WaterBetween(double source, double receiver, const KeptOcean& kept);
};

/// The same path after its ends have moved by metres: Newton's method for r(σ) = range on its own
/// branch, from the ray that it was, until it misses by less than 0.01 mm.
///
/// Null wherever a search might find something else: if the ray comes to turn beyond the next
/// singular ray of the fan, or nearer to it than four times its own step; if dr/dσ changes by more
/// than a third on the way (an extremum of r, where a neighbour of the same history would meet it,
/// is then at least three steps off); if it leaves the limits. docs/theory/layered-rays.md,
/// "Following a path"
/// \param range  between the ends [m]   \param frequency  that sets losses [Hz]
[[nodiscard]] std::optional<Arrival> followed_branch(const Environment& ocean,
                                                     const WaterBetween& water, double range,
                                                     double frequency, const Arrival& known,
                                                     const PathLimits& limits);

}  // namespace asdic::detail
