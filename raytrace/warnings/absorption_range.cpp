#include <array>

#include "raytrace/ocean/absorption_validity.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

constexpr ValidRange bubble_ranges[] = {{"frequency", "Hz", 1e4, 1e5}};
constexpr Validity bubble_validity{"the surface bubble loss", "APL-UW TR 9407, 1994",
                                   bubble_ranges};

}  // namespace

std::string bubble_range(const Environment& ocean, double lowest, double highest) {
  if (!(ocean.surface.roughness.bubble_wind > 0.0)) return "";
  const std::array<Asked, 1> asked{{{"frequency", lowest, highest}}};
  const std::string text = asdic::detail::outside(bubble_validity, asked);
  return text.empty() ? "" : "environment.surface.bubbles: " + text;
}

std::string absorption_range(const Environment& ocean, double lowest, double highest) {
  const std::optional<Validity> law = validity(ocean.absorption, highest);
  if (!law) return "";
  std::vector<Asked> asked{{"frequency", lowest, highest}};
  for_each_water_property(ocean.absorption, [&](std::string_view quantity, double value) {
    asked.push_back({quantity, value, value});
  });
  const std::string text = asdic::detail::outside(*law, asked);
  return text.empty() ? "" : "environment.absorption: " + text;
}

}  // namespace asdic::detail::checks
