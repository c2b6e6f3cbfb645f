#pragma once
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Where a leg begins and ends, and its frequency.
struct LegEnds {
  double source_depth, receiver_depth, range;  ///< [m]
  double frequency;                            ///< [Hz]
  bool layered = true;                         ///< is_layered()
  bool in_volume = false;                      ///< focused across vertical planes, too
};

/// Most that the paths of one leg may bring together, Σ(|A|² + scattered) of a unit source at 1 m
/// [1/m² × 1 m²]: 64 times
///
///   1/d² + (8/π)·k·s²/d + π/(d·H)
///
/// spherical spreading over the distance d, a perfect focus of all waves that the water turns, s
/// the sine of the steepest of them, and sound kept between the boundaries, H apart. Where anything
/// varies with range s is 1 and H half a wavelength. docs/theory/energy-bound.md
[[nodiscard]] double most_intensity(const Environment& ocean, const LegEnds& ends) noexcept;

/// Returns where paths bring no more than energy lets them.
/// \throws RunError  naming the loudest path, the leg, the level and the bound
void ensure_bounded(const Arrivals& paths, const Environment& ocean, const LegEnds& ends);

}  // namespace asdic::detail
