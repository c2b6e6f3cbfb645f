#include "io/scenario/profiles/temperature_salinity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::detail::scenario {
namespace {

/// A warning when an equation is asked about water that it was not measured in.
void note_range(const TemperatureSalinityProfile& form, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < form.temperature.size(); ++i) {
    const double megapascal = 1e-6 * gauge_pressure(form.depth[i], form.latitude_deg);
    const std::array<Asked, 4> asked{{{"temperature", form.temperature[i], form.temperature[i]},
                                      {"salinity", form.salinity[i], form.salinity[i]},
                                      {"depth", form.depth[i], form.depth[i]},
                                      {"pressure", megapascal, megapascal}}};
    const std::string text = outside(validity(form.equation), asked);
    if (text.empty()) continue;
    notes.push_back("environment.sound_speed: at " + to_text(form.depth[i]) + " m " + text);
    return;
  }
}

}  // namespace

void TemperatureSalinityProfile::make(const WaterToMake& to) const {
  const Boundary& bottom = to.ocean.bottom;
  const double bottom_depth = bottom.shape ? bottom.shape->deepest() : bottom.depth;
  note_range(*this, to.reading.notes);
  add_warnings({checks::profile_reach(depth.front(), depth.back(), to.ocean,
                                      "the water is like that at the first and last")},
               to.reading.notes);
  std::vector<double> depths, speeds;
  const auto add = [&](double z, std::size_t level) {
    depths.push_back(z);
    speeds.push_back(sound_speed(equation, temperature[level], salinity[level], z, latitude_deg));
  };
  // Water above the first and below the last level is like that level, but under its own pressure:
  // levels at most 250 m apart keep the pressure's part of the gradient.
  if (depth.front() > 0.0) add(0.0, 0);
  for (std::size_t level = 0; level < depth.size(); ++level) add(depth[level], level);
  const double rest = std::max(0.0, bottom_depth - depth.back());
  const auto extra = static_cast<int>(std::ceil(rest / 250.0));
  for (int i = 1; i <= extra; ++i) add(depth.back() + rest * i / extra, depth.size() - 1);
  to.ocean.water = profile_of(to.table, depths, speeds, interpolation);
}

}  // namespace asdic::detail::scenario
