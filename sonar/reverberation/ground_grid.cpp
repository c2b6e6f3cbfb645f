#include "sonar/reverberation/ground_grid.h"

#include <algorithm>

#include "reverb/fields/ground_spacing.h"

namespace asdic::detail {
namespace {

constexpr double finest_ground = 1.0;  // [m]

}  // namespace

double ground_spacing(const Scenario& scenario, const Pulse& pulse, const PropagationPaths& paths) {
  if (scenario.reverberation.ground_spacing) return *scenario.reverberation.ground_spacing;
  const double by_pulse = ground_spacing(pulse.bandwidth_99(), speed_at_surface(scenario, paths));
  const auto& shape = scenario.environment.surface.shape;
  if (!shape || shape->ranges().size() < 2) return by_pulse;
  const double facet = (shape->ranges().back() - shape->ranges().front()) /
                       static_cast<double>(shape->ranges().size() - 1);
  return std::min(by_pulse, std::max(facet, finest_ground));
}

double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths) {
  Vec3 place = scenario.platforms[0].track.at(0.0).position;
  place.z() = paths.surface_depth(place);
  return paths.speed_at(place);
}

}  // namespace asdic::detail
