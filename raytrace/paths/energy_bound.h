#pragma once
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Ends of a leg, its frequency, and what kind of ocean it is in.
struct LegEnds {
  double source_depth, receiver_depth, range;  ///< [m]
  double frequency;                            ///< [Hz]
  bool layered = true;                         ///< is_layered()
  bool in_volume = false;                      ///< rays may be focused across vertical planes, too
};

/// Upper bound of the intensity Σ(|A|² + scattered) of all paths of one leg, relative to 1 m from
/// the source:
///
///   64·(1/d² + (8/π)·k·s²/d + π/(d·H))
///
/// The terms are spherical spreading over the distance d [m], a perfect focus of all waves that the
/// water turns, s being the sine of the steepest of them, and sound kept between boundaries that
/// are H apart [m]. Where anything varies with range, s is 1 and H half a wavelength.
/// Source: docs/theory/energy-bound.md, eq. (2)
[[nodiscard]] double most_intensity(const Environment& ocean, const LegEnds& ends) noexcept;

/// Returns the intensity of all paths of a leg divided by most_intensity(), which is above 1 where
/// it is more than energy allows; or 0 without the bound, where that cannot be.
[[nodiscard]] double excess(const Arrivals& paths, const Environment& ocean, const LegEnds& ends);

/// Checks that the paths of a leg are together no louder than most_intensity().
/// \throws RunError  naming the loudest path, the leg, the level and the bound
void ensure_bounded(const Arrivals& paths, const Environment& ocean, const LegEnds& ends);

}  // namespace asdic::detail
