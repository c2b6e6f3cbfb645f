#pragma once
#include <span>
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// The order of arrivals: by delay.
[[nodiscard]] inline bool earlier(const Arrival& a, const Arrival& b) noexcept {
  return a.delay != b.delay ? a.delay < b.delay : a.launch_elevation < b.launch_elevation;
}

/// Unreflected rays flatter than this at both ends are not taken from r(σ) [rad]: 1 − ξ²c² = sin²θ
/// is known to some 4·10⁻¹⁶, and beside an extremum of c, where range is all a matter of the angles
/// on the way, they would be off by 10⁻⁸ of themselves and more.
inline constexpr double flattest = 2e-4;
/// The same where the speed does not change and r(σ) is one quotient.
inline constexpr double flattest_straight = 1e-6;

/// Whether a path is so flat. \param at_source  the water there
[[nodiscard]] bool is_flat(const Arrival& path, const SoundSpeed& at_source) noexcept;

/// Adds the ray that stays near the source's depth, which r(σ) cannot tell, in place of those that
/// cannot be told from it: where the speed has no gradient to speak of, to receivers that it comes
/// to at less than `flattest`, and along a kink of least speed (LevelRays).
/// \param ranges, found  [n] of the receivers
void put_level_paths(const Environment& ocean, double frequency, double source_depth,
                     double receiver_depth, std::span<const double> ranges,
                     std::vector<Arrivals>& found);

}  // namespace asdic::detail
