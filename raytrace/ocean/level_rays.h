#pragma once
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// The rays of a source on a kink of least sound speed that cannot be told from the level one.
///
/// With c = c₀ + g|z − z₀| on either side (each side its own g), a ray launched at a small angle α
/// runs in arcs of length 2cα/g and height cα²/(2g): ever more of them, ever lower, without end as
/// α goes to zero. The rays that reach a receiver at z₀ are infinitely many, each with the same
/// amplitude 1/r, and their delays have a limit: their sum has none. Receivers further from z₀ than
/// `height` are not reached by them at all. So a fan is no denser than `angle` there.
/// docs/theory/fields.md
struct LevelRays {
  double angle = 0.0;   ///< launch elevations below this are of this kind [rad]; 0: none is
  double height = 0.0;  ///< they stay so close to the source's depth: λ/1000 [m]
  /// Depth of the kink, at most a millimetre from the source [m]. The level ray is followed from
  /// here, because a ray from beside the kink winds about it and has only the q of its last arc.
  double depth = 0.0;
};

/// \param frequency [Hz]   \param range, depth  of the source [m]
[[nodiscard]] LevelRays level_rays(const Environment& environment, double frequency, double range,
                                   double depth) noexcept;

/// The same for paths to receivers no further from the source's depth: rays that stay within λ/4 of
/// it are one arrival there, the level one. (Fans are denser: receivers a little further off, and
/// oceans whose axis moves with range, resolve more of them.)
[[nodiscard]] LevelRays level_paths(const Environment& environment, double frequency, double range,
                                    double depth) noexcept;

/// Leaves of the paths to one receiver within LevelRays::height of the source's depth only the
/// level one of those that are not resolved, if it is among them.
void merge_level_paths(const LevelRays& level, Arrivals& arrivals);

}  // namespace asdic::detail
