#include "raytrace/cases/propagation_case.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "raytrace/ocean/slice.h"

namespace asdic::detail {

double SourcePattern::at(double launch_elevation) const noexcept {
  assert(!elevation.empty() && amplitude.size() == elevation.size());
  if (elevation.size() == 1) return amplitude.front();
  // The pair of rows around the angle; the first or the last pair goes on beyond them.
  const auto first = elevation.begin() + 1, last = elevation.end() - 1;
  const auto i =
      static_cast<std::size_t>(std::upper_bound(first, last, launch_elevation) - elevation.begin());
  const double share = (launch_elevation - elevation[i - 1]) / (elevation[i] - elevation[i - 1]);
  return amplitude[i - 1] + share * (amplitude[i] - amplitude[i - 1]);
}

Environment plane_of(const PropagationCase& run_case) {
  if (run_case.on_area && run_case.off_transect != 0.0)
    return run_case.on_area->area->section(
        run_case.on_area->place, run_case.on_area->bearing + run_case.off_transect, reach_of_area);
  return slice(run_case.environment, 0.0, std::cos(run_case.off_transect));
}

double reach_on_map(const PropagationCase& run_case, double most) {
  if (!run_case.on_area) return most;
  const auto& [area, place, bearing] = *run_case.on_area;
  return area->reach_on_map(place, bearing + run_case.off_transect, most);
}

}  // namespace asdic::detail
