#include <array>

#include "raytrace/ocean/absorption_validity.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::checks {

std::string absorption_range(const Environment& ocean, double lowest, double highest) {
  const std::optional<Validity> law = validity(ocean.absorption, highest);
  if (!law) return "";
  std::vector<Asked> asked{{"frequency", lowest, highest}};
  if (const auto* water = std::get_if<FrancoisGarrison>(&ocean.absorption))
    asked.insert(asked.end(), {{"temperature", water->temperature, water->temperature},
                               {"salinity", water->salinity, water->salinity},
                               {"depth", water->depth, water->depth}});
  const std::string text = outside(*law, asked);
  return text.empty() ? "" : "environment.absorption: " + text;
}

}  // namespace asdic::checks
