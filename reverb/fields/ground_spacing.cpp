#include "reverb/fields/ground_spacing.h"

#include <algorithm>

namespace asdic::detail {
namespace {

constexpr double finest_ground = 1.0;  // [m]

}  // namespace

double ground_spacing(const ReverberationSettings& settings, const Environment& ocean,
                      double bandwidth, double sound_speed) {
  if (settings.ground_spacing) return *settings.ground_spacing;
  const double by_pulse = sound_speed / (4.0 * bandwidth);  // delay 2Δr/c = 1/(2B)
  const auto& shape = ocean.surface.shape;
  if (!shape || shape->ranges().size() < 2) return by_pulse;
  const double facet = (shape->ranges().back() - shape->ranges().front()) /
                       static_cast<double>(shape->ranges().size() - 1);
  return std::min(by_pulse, std::max(facet, finest_ground));
}

}  // namespace asdic::detail
