#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/text.h"
#include "io/climatology/climatology.h"

namespace asdic::detail {
namespace {

std::string fixed(double value, int digits) {
  char text[64] = {};
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string array(const std::vector<double>& values, int digits) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += i == 0 ? "" : i % 10 == 0 ? ",\n  " : ", ";
    text += fixed(values[i], digits);
  }
  return text + "]";
}

std::string profile_table(const OceanSample& ocean) {
  std::string text = "kind = \"temperature-salinity\"\n";
  text += "equation = \"chen-millero\"\nlatitude_deg = " + to_text(ocean.latitude) + "\n";
  text += "interpolation = \"pchip\"\n";
  const bool whole = std::all_of(ocean.depth.begin(), ocean.depth.end(),
                                 [](double z) { return z == std::round(z); });
  text += "depth = " + array(ocean.depth, whole ? 0 : 1) + "  # [m]\n";
  text += "temperature = " + array(ocean.temperature, 3) + "  # [degC]\n";
  text += "salinity = " + array(ocean.salinity, 3) + "  # [psu]\n";
  return text;
}

std::string section_table(const OceanSection& section) {
  std::string text = "kind = \"section\"\nrange = " + array(section.station, 0) + "  # [m]\n";
  text += "depth = " + array(section.depth, 0) + "  # [m]\n";
  text += "speed = [  # [m/s], a row for every range\n";
  const std::size_t n = section.depth.size();
  for (std::size_t i = 0; i < section.station.size(); ++i) {
    const auto row = section.speed.begin() + static_cast<std::ptrdiff_t>(i * n);
    text += array({row, row + static_cast<std::ptrdiff_t>(n)}, 2) + ",\n";
  }
  return text + "]\n";
}

}  // namespace

std::string write_scenario_fragment(const OceanSample& ocean,
                                    const std::optional<OceanSection>& section) {
  std::string text = "# The ocean at " + to_text(ocean.latitude) + " N " +
                     to_text(ocean.longitude) + " E" + ", " +
                     (ocean.month ? "month " + std::to_string(*ocean.month) : "mean of the year") +
                     ". Written by asdic ocean.\n";
  for (const std::string& origin : ocean.origins) text += "# " + origin + "\n";
  for (const std::string& note : ocean.notes) text += "# Note: " + note + ".\n";
  if (section)
    for (const std::string& note : section->notes) text += "# Note: " + note + ".\n";
  text += "\n[environment]\n";
  if (ocean.wind_speed) text += "wind_speed = " + fixed(*ocean.wind_speed, 1) + "  # [m/s]\n";
  if (section)
    text +=
        "\n[environment.transect]  # where range 0 is on the map, and where ranges grow\n"
        "origin = [0.0, 0.0]\nbearing_deg = " +
        to_text(section->bearing_deg) + "\n";
  const bool fronts = section && section->station.size() > 1;
  text += "\n[environment.sound_speed]\n";
  text += fronts ? section_table(*section) : profile_table(ocean);
  text += "\n[environment.bottom]\n";
  if (!section) text += "depth = " + fixed(ocean.water_depth, 0) + "  # [m]\n";
  text += "kind = \"fluid\"  # the data say nothing of the sediment: this is abyssal clay\n";
  text += "speed = 1520.0\ndensity = 1400.0\nattenuation_db_per_wavelength = 0.1\n";
  if (section) {
    text += "\n[environment.bottom.shape]\ninterpolation = \"smooth\"\n";
    text += "range = " + array(section->range, 0) + "  # [m]\n";
    text += "depth = " + array(section->floor, 0) + "  # [m]\n";
  }
  return text;
}

}  // namespace asdic::detail
