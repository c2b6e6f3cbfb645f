// Part of case_parts.h: the files beside an .env file.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/quantities.h"
#include "core/units.h"
#include "io/bellhop/case_parts.h"
#include "io/files/input_file.h"
#include "io/scenario/sections.h"
#include "raytrace/ocean/strongest_reflection.h"

namespace asdic::detail::bellhop {
namespace {

constexpr std::int64_t most_nodes = 10'000'000;  // memory is taken as rows are read, not before

/// An angle, a range … that must be above the one before.
double increasing(ListReader& from, const std::vector<double>& before, const char* item,
                  const char* unit) {
  const double value = from.need_real(item);
  if (!before.empty() && value <= before.back())
    from.fail(item, shown(value) + unit, "above the one before, " + shown(before.back()) + unit);
  return value;
}

/// Nodes of the bottom above the surface: rays end or turn back before they come there.
void note_dry_nodes(CaseReading& reading, const std::string& file, const std::vector<double>& range,
                    const std::vector<double>& depth) {
  const Boundary& surface = reading.ocean().surface;
  std::size_t dry = 0, first = 0;
  for (std::size_t i = depth.size(); i-- > 0;)
    if (depth[i] < surface.depth_at(range[i])) {
      ++dry;
      first = i;
    }
  if (dry > 0)
    reading.note(file + ": " + std::to_string(dry) + " of " + std::to_string(depth.size()) +
                 " nodes are above the surface, the first of them node " +
                 std::to_string(first + 1) + " at " + shown(range[first] / 1000.0) + " km, " +
                 shown(depth[first]) + " m deep: no sound gets past them");
}

}  // namespace

ListReader CaseReading::companion(const std::string& extension,
                                  const std::string& wanted_for) const {
  for (const auto& [name, text] : texts.companions)
    if (name == extension) return {text, root + extension};
  throw InputError(
      {.where = root + extension,
       .got = what_is_at(root + extension),
       .expected = "the file that \"" + wanted_for + "\" in " + env.file() + " asks for"});
}

void read_section(CaseReading& reading, const std::vector<double>& depth,
                  const std::vector<double>& speed_of_env) {
  ListReader file = reading.companion(".ssp", "Q");
  file.begin("number of profiles");
  constexpr std::int64_t most_speeds = 10'000'000;
  const auto n = std::size_t(file.need_integer(
      "", 1, std::min<std::int64_t>(100'000, most_speeds / std::int64_t(depth.size()))));
  file.end();

  std::vector<double> range;
  file.begin("ranges");
  for (std::size_t i = 0; i < n; ++i) range.push_back(increasing(file, range, "range", " km"));
  file.end();
  for (double& r : range) r *= 1000.0;

  std::vector<double> speed(n * depth.size());
  for (std::size_t j = 0; j < depth.size(); ++j) {
    file.begin("speeds at " + shown(depth[j]) + " m");
    for (std::size_t i = 0; i < n; ++i) {
      const double c = file.need_real("speed");
      if (!quantity::sound_speed.holds(c))
        file.fail("speed", shown(c) + " m/s", quantity::sound_speed.expected());
      speed[i * depth.size() + j] = c;
    }
    file.end();
  }

  SoundSpeedSection section(range, depth, speed);
  std::vector<double> at_source;
  for (const double z : depth) at_source.push_back(section.at(0.0, z).c);
  reading.ocean().water = SoundSpeedProfile::table(depth, at_source, Interpolation::c_linear);
  reading.ocean().section = std::move(section);
  (void)speed_of_env;  // only its attenuation counts, and that is per metre by now
}

BoundaryShape read_shape(CaseReading& reading, bool surface) {
  ListReader file = reading.companion(surface ? ".ati" : ".bty", "~");
  file.begin("type");
  std::string type;
  if (!file.text(type, "")) file.fail("", "no value", "L or C, and S or L, in quotes");
  type.resize(std::max<std::size_t>(type.size(), 2), ' ');
  if (type[0] != 'L' && type[0] != 'C')
    file.fail("letter 1", shown(type.substr(0, 1)), "L (piecewise linear) or C (curvilinear)");
  if (type[1] != ' ' && type[1] != 'S' && type[1] != 'L')
    file.fail("letter 2", shown(type.substr(1, 1)),
              "a blank, S (short) or L (long, with materials)");
  file.end();
  if (type[0] == 'C' && type[1] != ' ')
    reading.note(file.file() + ": curvilinear as of type 'C'; BELLHOP mistakes '" +
                 type.substr(0, 2) + "' and keeps the normals of facets");

  const char letter = surface ? reading.options.surface : reading.options.bottom;
  const bool with_materials = type[1] == 'L', they_count = letter == 'A' || letter == 'G';
  if (with_materials && !they_count)
    reading.note(file.file() + ": its materials change nothing, since the " +
                 (surface ? "surface" : "bottom") + " is not a half space (option '" + letter +
                 "')");

  file.begin("number of nodes");
  const std::int64_t n = file.need_integer("", 1, most_nodes);
  file.end();
  std::vector<double> range, depth;
  std::vector<BoundaryMaterial> material;
  for (std::int64_t i = 0; i < n; ++i) {
    file.begin("node " + std::to_string(i + 1));
    range.push_back(increasing(file, range, "range", " km"));
    depth.push_back(file.need_real("depth"));
    if (!surface && depth.back() > reading.bottom_depth)
      file.fail("depth", shown(depth.back()) + " m",
                "not below the profile, which ends at " + shown(reading.bottom_depth) + " m");
    if (surface && depth.back() < reading.surface_depth)
      file.fail("depth", shown(depth.back()) + " m",
                "not above the profile, which begins at " + shown(reading.surface_depth) + " m");
    if (with_materials) {
      MaterialRow row;
      row.speed = file.need_real("speed");
      row.shear_speed = file.need_real("shear speed");
      row.density = file.need_real("density");
      row.attenuation = file.need_real("attenuation");
      row.shear_attenuation = file.need_real("shear attenuation");
      if (they_count)  // always dB per wavelength, and without the volume loss
        material.push_back(half_space(reading, file, row, AttenuationUnit::db_per_wavelength, 0.0));
    }
    file.end();
  }
  for (double& r : range) r *= 1000.0;
  if (!surface) note_dry_nodes(reading, file.file(), range, depth);
  return {range, depth,
          type[0] == 'L' ? ShapeInterpolation::piecewise_linear : ShapeInterpolation::curvilinear,
          std::move(material)};
}

ReflectionTable read_reflection_table(CaseReading& reading, bool surface) {
  ListReader file = reading.companion(surface ? ".trc" : ".brc", "F");
  file.begin("number of rows");
  const std::int64_t n = file.need_integer("", 1, most_nodes);
  file.end();
  ReflectionTable table;
  std::vector<double> angle;
  for (std::int64_t i = 0; i < n; ++i) {
    file.begin("row " + std::to_string(i + 1));
    angle.push_back(increasing(file, angle, "angle", " degrees"));
    if (!(angle.back() >= 0.0 && angle.back() <= 90.0))
      file.fail("angle", shown(angle.back()) + " degrees", "a grazing angle from 0 to 90 degrees");
    table.grazing.push_back(radians(angle.back()));
    table.magnitude.push_back(file.need_real("magnitude"));
    if (table.magnitude.back() > 1.0 && table.magnitude.back() <= most_reflection)
      table.magnitude.back() = 1.0;
    if (!(table.magnitude.back() >= 0.0 && table.magnitude.back() <= 1.0))
      file.fail("magnitude", shown(table.magnitude.back()),
                "a magnitude from 0 to 1: no boundary reflects more than comes in");
    table.phase.push_back(radians(file.need_real("phase")));
    file.end();
  }
  return table;
}

SourcePattern read_source_pattern(CaseReading& reading) {
  ListReader file = reading.companion(".sbp", "*");
  file.begin("number of rows");
  const std::int64_t n = file.need_integer("", 2, most_nodes);
  file.end();
  std::vector<double> declination;
  SourcePattern pattern;
  for (std::int64_t i = 0; i < n; ++i) {
    file.begin("row " + std::to_string(i + 1));
    declination.push_back(increasing(file, declination, "angle", " degrees"));
    if (!(std::abs(declination.back()) <= 360.0))
      file.fail("angle", shown(declination.back()) + " degrees",
                "an angle from -360 to 360 degrees");
    const double level = file.need_real("level");
    if (!(level < 1000.0)) file.fail("level", shown(level) + " dB", "a level below 1000 dB");
    pattern.amplitude.push_back(amplitude_from_db(level));
    file.end();
  }
  // elevation is positive up, and increases
  for (std::size_t i = declination.size(); i-- > 0;)
    pattern.elevation.push_back(radians(-declination[i]));
  std::reverse(pattern.amplitude.begin(), pattern.amplitude.end());
  return pattern;
}

}  // namespace asdic::detail::bellhop
