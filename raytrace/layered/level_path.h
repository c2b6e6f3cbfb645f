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

/// Least angle at either end at which unreflected rays are taken from r(σ) [rad]. sin²θ = 1 − ξ²c²
/// is known to about 4·10⁻¹⁶. Beside an extremum of c the range depends on the angles along the
/// path alone, so flatter rays would be wrong by 10⁻⁸ of themselves or more.
inline constexpr double flattest = 2e-4;
/// The same angle where the speed does not change, so that r(σ) is one quotient [rad].
inline constexpr double flattest_straight = 1e-6;

/// Whether a path is unreflected and flatter than these angles. \param at_source  water there
[[nodiscard]] bool is_flat(const Arrival& path, const SoundSpeed& at_source) noexcept;

/// Adds the ray that stays near the source's depth, which r(σ) does not resolve, and removes those
/// that r(σ) cannot distinguish from it. This is done where the speed has next to no gradient, for
/// receivers that the ray reaches at less than `flattest`, and along a kink of least speed
/// (LevelRays). \param ranges, found  [n] of the receivers
void put_level_paths(const Environment& ocean, double frequency, double source_depth,
                     double receiver_depth, std::span<const double> ranges,
                     std::vector<Arrivals>& found);

}  // namespace asdic::detail
