// Part of climatology.h: the [environment] that a scenario includes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/text.h"
#include "io/climatology/climatology.h"
#include "io/climatology/water.h"

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

int digits_of(const std::vector<double>& values) {
  const bool whole =
      std::all_of(values.begin(), values.end(), [](double z) { return z == std::round(z); });
  return whole ? 0 : 1;
}

std::string quoted(const std::string& text) {
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return safe + '"';
}

/// A comment or a value of one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

std::string head(const OceanSample& ocean, const std::vector<std::string>& more_notes) {
  const std::string when =
      ocean.when.month || ocean.when.date ? ocean.when.text() : "mean of the data's times";
  std::string text = "# The ocean at " + climatology::place(ocean.latitude, ocean.longitude) +
                     ", " + when + ". Written by asdic ocean.\n";
  for (const std::string& origin : ocean.origins) text += "# " + one_line(origin) + "\n";
  for (const auto* notes : {&ocean.notes, &more_notes})
    for (const std::string& note : *notes) text += "# Note: " + one_line(note) + ".\n";
  return text;
}

/// [environment.origin]; quantities of one file stand together.
std::string origin_table(const OceanSample& ocean) {
  std::string text =
      "\n[environment.origin]  # of the map's [0, 0], and what the ocean is made of\n";
  text += "latitude_deg = " + to_text(ocean.latitude) +
          "\nlongitude_deg = " + to_text(ocean.longitude) +
          "\ntime = " + quoted(ocean.when.text()) + "\n";
  std::vector<OceanSource> joined;
  for (const OceanSource& source : ocean.sources) {
    const auto same = std::find_if(joined.begin(), joined.end(), [&](const OceanSource& other) {
      return other.name == source.name && other.digest == source.digest &&
             other.time == source.time;
    });
    if (same == joined.end()) {
      joined.push_back(source);
      continue;
    }
    same->quantity += ", " + source.quantity;
    same->variable += ", " + source.variable;
  }
  for (const OceanSource& source : joined) {
    text += "[[environment.origin.source]]\nquantity = " + quoted(source.quantity) +
            "\nname = " + quoted(source.name) + "\nvariable = " + quoted(source.variable) +
            "\ndigest = " + quoted(source.digest) + "\n";
    if (!source.time.empty()) text += "time = " + quoted(source.time) + "\n";
  }
  return text;
}

std::string profile_table(const OceanSample& ocean, double deepest) {
  if (!ocean.speed.empty()) {
    std::vector<double> depth = ocean.depth;
    if (depth.front() > 0.0) depth.insert(depth.begin(), 0.0);
    while (depth.back() < deepest || depth.size() < 2) depth.push_back(depth.back() + 250.0);
    const auto speed = climatology::speeds_of(
        {.depth = ocean.depth, .temperature = {}, .salinity = {}, .speed = ocean.speed}, depth,
        ocean.latitude);
    return "kind = \"table\"\ninterpolation = \"pchip\"\ndepth = " +
           array(depth, digits_of(depth)) + "  # [m]\nspeed = " + array(speed, 2) + "  # [m/s]\n";
  }
  std::string text = "kind = \"temperature-salinity\"\n";
  text += "equation = \"chen-millero\"\nlatitude_deg = " + to_text(ocean.latitude) + "\n";
  text += "interpolation = \"pchip\"\n";
  text += "depth = " + array(ocean.depth, digits_of(ocean.depth)) + "  # [m]\n";
  text += "temperature = " + array(ocean.temperature, 3) + "  # [degC]\n";
  text += "salinity = " + array(ocean.salinity, 3) + "  # [psu]\n";
  return text;
}

std::string section_table(const OceanSection& section) {
  std::string text =
      "kind = \"section\"\nrange = " + array(section.station, digits_of(section.station)) +
      "  # [m]\n";
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
  std::string text = head(ocean, section ? section->notes : std::vector<std::string>{});
  text += "\n[environment]\n";
  if (ocean.wind_speed) text += "wind_speed = " + fixed(*ocean.wind_speed, 1) + "  # [m/s]\n";
  text += origin_table(ocean);
  if (section)
    text +=
        "\n[environment.transect]  # where range 0 is on the map, and where ranges grow\n"
        "origin = [0.0, 0.0]\nbearing_deg = " +
        to_text(section->bearing_deg) + "\n";
  const bool fronts = section && section->station.size() > 1;
  double deepest = ocean.water_depth;
  if (section)
    deepest = std::max(deepest, *std::max_element(section->floor.begin(), section->floor.end()));
  text += "\n[environment.sound_speed]\n";
  text += fronts ? section_table(*section) : profile_table(ocean, deepest);
  text += "\n[environment.bottom]\n";
  if (!section)
    text += "depth = " + fixed(ocean.water_depth, ocean.water_depth < 500.0 ? 1 : 0) + "  # [m]\n";
  const bool by_map = section && !section->sediment.empty();
  if (!by_map) text += "# " + ocean.sediment_by + "\n" + ocean.sediment.toml();
  if (section) {
    text += "\n[environment.bottom.shape]\ninterpolation = \"smooth\"\n";
    text += "range = " + array(section->range, digits_of(section->range)) + "  # [m]\n";
    const bool shallow = *std::min_element(section->floor.begin(), section->floor.end()) < 500.0;
    text += "depth = " + array(section->floor, shallow ? 1 : 0) + "  # [m]\n";
    if (by_map)
      for (const Sediment& sediment : section->sediment)
        text += "[[environment.bottom.shape.material]]\n" + sediment.toml();
  }
  return text;
}

std::string write_area_fragment(const OceanSample& centre, const OceanArea& area) {
  std::string text = head(centre, area.notes);
  const std::string file = "file = " + quoted(area.file.filename().string()) + "\n";
  text += "\n[environment]\n";
  if (!area.wind && centre.wind_speed)
    text += "wind_speed = " + fixed(*centre.wind_speed, 1) + "  # [m/s]\n";
  text += origin_table(centre);
  text += "\n[environment.area]  # " + to_text(area.side / 1000.0) +
          " km square about the map's [0, 0]\n";
  text += "\n[environment.area.bathymetry]\n" + file +
          "variable = \"elevation\"\ninterpolation = \"bicubic\"\n";
  if (area.sound_speed)
    text += "\n[environment.area.sound_speed]\n" + file + "variable = \"sound_speed\"\n";
  text +=
      "\n[environment.area.seabed]  # a class for each cell\n" + file + "variable = \"sediment\"\n";
  for (const Sediment& sediment : area.classes)
    text += "[[environment.area.seabed.class]]\nnumber = " + std::to_string(sediment.number) +
            "\nname = " + quoted(sediment.name) + "\n" + sediment.toml();
  if (area.wind) text += "\n[environment.area.wind]\n" + file + "variable = \"wind_speed\"\n";
  if (!area.sound_speed)
    text += "\n[environment.sound_speed]  # everywhere\n" + profile_table(centre, 12000.0);
  text += "\n[environment.bottom]  # where the map says nothing\n# " + centre.sediment_by + "\n" +
          centre.sediment.toml();
  return text;
}

}  // namespace asdic::detail
