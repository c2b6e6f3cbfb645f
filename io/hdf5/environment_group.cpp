#include "io/hdf5/environment_group.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "io/hdf5/scale.h"

namespace asdic::detail {
namespace {

constexpr std::size_t samples = 501;  // a picture is about a thousand pixels wide and 500 high

std::vector<double> evenly(double first, double last) {
  std::vector<double> values(samples);
  for (std::size_t i = 0; i < samples; ++i)
    values[i] = std::lerp(first, last, static_cast<double>(i) / (samples - 1.0));
  return values;
}

/// Even steps, and every node of a boundary between the ends.
std::vector<double> boundary_ranges(const Environment& ocean, double first, double last) {
  std::vector<double> ranges = evenly(first, last);
  for (const Boundary* boundary : {&ocean.surface, &ocean.bottom})
    if (boundary->shape)
      for (const double node : boundary->shape->ranges())
        if (node > first && node < last) ranges.push_back(node);
  std::sort(ranges.begin(), ranges.end());
  ranges.erase(std::unique(ranges.begin(), ranges.end()), ranges.end());
  return ranges;
}

void scale(Hdf5File& file, const std::string& name, const std::vector<double>& values,
           const std::string& long_name, const Meaning& meaning) {
  write_scale(file, "environment/" + name, name, values, long_name, "m", meaning);
}

void column(Hdf5File& file, const std::string& name, const std::vector<double>& values,
            const std::vector<std::string>& scales, const Shape& shape,
            const std::string& long_name, const std::string& units, const Meaning& meaning) {
  file.write<double>("environment/" + name, values, shape);
  describe(file, "environment/" + name, long_name, units, meaning);
  std::vector<std::string> paths;
  for (const std::string& axis : scales) paths.push_back("environment/" + axis);
  file.attach_scales("environment/" + name, paths);
}

}  // namespace

void write_environment_group(Hdf5File& file, const Environment& ocean, double first_range,
                             double last_range, double map_end) {
  if (!(last_range > first_range)) last_range = first_range + 1.0;
  const std::vector<double> ranges = boundary_ranges(ocean, first_range, last_range);
  std::vector<double> surface, bottom;
  for (const double r : ranges) {
    surface.push_back(ocean.surface.depth_at(r));
    bottom.push_back(ocean.bottom.depth_at(r));
  }
  scale(file, "boundary_range", ranges, "horizontal distance", cf::range_axis);
  column(file, "surface_depth", surface, {"boundary_range"}, {ranges.size()},
         "depth of the sea surface, positive down", "m", cf::of_boundary("surface"));
  column(file, "bottom_depth", bottom, {"boundary_range"}, {ranges.size()},
         "depth of the sea floor, positive down", "m", cf::of_boundary("bottom"));

  if (map_end < last_range) file.set_attribute("environment", "map_end_m", map_end);

  const double top = *std::min_element(surface.begin(), surface.end());
  const double deepest = *std::max_element(bottom.begin(), bottom.end());
  const std::vector<double> depths = evenly(top, deepest);
  std::vector<double> speed;
  for (const double z : depths)
    speed.push_back(ocean.section ? ocean.section->at(0.0, z).c : ocean.water.at(z).c);
  scale(file, "depth", depths, "depth, positive down", cf::depth_axis);
  column(file, "sound_speed", speed, {"depth"}, {depths.size()}, "speed of sound at range 0", "m/s",
         cf::sound_speed);
  if (!ocean.section) return;
  const auto r = ocean.section->ranges(), z = ocean.section->depths(), c = ocean.section->speeds();
  scale(file, "section_range", {r.begin(), r.end()}, "horizontal distance", cf::range_axis);
  scale(file, "section_depth", {z.begin(), z.end()}, "depth, positive down", cf::depth_axis);
  column(file, "section_speed", {c.begin(), c.end()}, {"section_range", "section_depth"},
         {r.size(), z.size()}, "speed of sound", "m/s", cf::sound_speed);
}

std::optional<OriginAttributes> attributes_of(const std::optional<OceanOrigin>& origin) {
  if (!origin) return std::nullopt;
  return OriginAttributes{.latitude_deg = degrees(origin->latitude),
                          .longitude_deg = degrees(origin->longitude),
                          .time = origin->time,
                          .sources = origin->source_lines()};
}

void write_origin(Hdf5File& file, const std::optional<OriginAttributes>& origin) {
  if (!origin) return;
  file.set_attribute("", "latitude_deg", origin->latitude_deg);
  file.set_attribute("", "longitude_deg", origin->longitude_deg);
  if (!origin->time.empty()) file.set_attribute("", "ocean_time", origin->time);
  if (!origin->sources.empty()) file.set_attribute("", "ocean_sources", origin->sources);
}

std::optional<OriginAttributes> read_origin_attributes(const Hdf5File& file) {
  if (!file.has_attribute("", "latitude_deg") || !file.has_attribute("", "longitude_deg"))
    return std::nullopt;
  OriginAttributes origin{.latitude_deg = file.attribute_number("", "latitude_deg"),
                          .longitude_deg = file.attribute_number("", "longitude_deg"),
                          .time = file.attribute_or("", "ocean_time", "")};
  if (file.has_attribute("", "ocean_sources"))
    origin.sources = file.attribute_texts("", "ocean_sources");
  return origin;
}

}  // namespace asdic::detail
