#pragma once
#include <span>
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/tracing/ray_tracer.h"
#include "raytrace/tracing/receiver_columns.h"
#include "raytrace/tracing/search_watch.h"

namespace asdic::detail {

/// The fan that is searched, and what is kept of it.
struct FanLimits {
  double lowest = -1.5707963267948966, highest = 1.5707963267948966;  ///< launch elevations [rad]
  int max_surface_bounces = 1 << 20, max_bottom_bounces = 1 << 20;
  int max_turns = 256;    ///< in the water: in a duct ever smaller cycles have no end
  double faintest = 0.0;  ///< product of reflection magnitudes below which a path is not followed
  double min_depth = -1e300, max_depth = 1e300;  ///< rays end there [m]
  double min_range = -1e300, max_range = 1e300;  ///< and there [m]
};

/// Every path from a source to receivers anywhere in a range-dependent ocean.
///
/// One fan of marched rays serves all receivers. Between two neighbours that share their history up
/// to a leg, the depth at which rays cross a receiver's range is a Hermite cubic in the launch
/// angle, its slopes from q; the fan is split until the cubics tell the rays between, and where
/// histories part. Crossings of a receiver's depth, and pairs hidden between two rays that miss on
/// the same side, are refined by Newton's method on re-traced rays to a miss below a hundredth of a
/// millimetre. docs/theory/eigenrays.md
///
/// A receiver at the depth of a source on a kink of least sound speed has no end of paths; of those
/// that stay within a thousandth of a wavelength of that depth the level one is told (LevelRays).
///
/// \param receivers  [n]   \param watch  progress, interruption, completeness
/// \return [n] arrivals, each sorted by delay
[[nodiscard]] std::vector<Arrivals> marching_eigenrays(const RayTracer& tracer, double source_range,
                                                       double source_depth,
                                                       std::span<const ReceiverPoint> receivers,
                                                       const FanLimits& limits = {},
                                                       SearchWatch* watch = nullptr);

}  // namespace asdic::detail
