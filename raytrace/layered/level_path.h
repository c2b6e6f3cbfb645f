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

/// Adds the ray that stays at the source's depth, which r(σ) cannot tell, to arrivals of receivers
/// there, in place of those that cannot be told from it: along a depth where the speed has no
/// gradient, and along a kink of least speed (LevelRays). \param ranges, found  [n] of the
/// receivers
void put_level_paths(const Environment& ocean, double frequency, double source_depth,
                     double receiver_depth, std::span<const double> ranges,
                     std::vector<Arrivals>& found);

}  // namespace asdic::detail
