#include "io/scenario/profiles/profile.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace asdic::detail::scenario {

SoundSpeedProfile profile_of(const TomlTable& table, const std::vector<double>& depth,
                             const std::vector<double>& speed, Interpolation interpolation) {
  try {
    return SoundSpeedProfile::table(depth, speed, interpolation);
  } catch (const InputError& error) {
    throw table.fault(error.fault().where, error.fault().expected, error.fault().got);
  }
}

void check_reach(const TomlTable& table, const std::string& key, std::span<const double> depth,
                 std::span<const double> speed, const Environment& ocean) {
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const double surface =
      ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth;
  const auto ranges = ocean.section ? ocean.section->ranges() : std::span<const double>();
  for (const double z : {surface, bottom})
    for (std::size_t i = 0; i < std::max<std::size_t>(1, ranges.size()); ++i) {
      const double c = ocean.section ? ocean.section->at(ranges[i], z).c : ocean.water.at(z).c;
      if (!(c > 0.8 * *least && c < 1.25 * *most))
        throw table.fault(
            key, "levels that reach from the surface to the bottom at " + to_text(bottom) + " m",
            "levels from " + to_text(depth.front()) + " to " + to_text(depth.back()) +
                " m, by which the speed at " + to_text(z) + " m would be " +
                to_text(std::round(c)) + " m/s");
    }
}

std::vector<double> copied(std::span<const double> values) {
  return {values.begin(), values.end()};
}

}  // namespace asdic::detail::scenario
