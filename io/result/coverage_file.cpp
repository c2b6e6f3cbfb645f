#include "io/result/coverage_file.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "io/hdf5/earth.h"
#include "io/hdf5/scale.h"
#include "io/result/scene_file.h"

namespace asdic::detail {
namespace {

/// A layer's values over (depth, bearing, range), and what they are.
struct Column {
  const char* name;
  std::vector<float> CoverageLayer::*values;
  const char* meaning;
  const char* unit;
  Meaning cf = {};
};
constexpr const char* level_unit = "dB";
const Column columns[] = {
    {"echo_db", &CoverageLayer::echo_db,
     "level of the standard target's echo, mean over the cell, before the matched filter",
     level_unit, cf::level},
    {"reverberation_db", &CoverageLayer::reverberation_db,
     "level of reverberation at the echo's time in the beam that looks at it", level_unit,
     cf::level},
    {"noise_db", &CoverageLayer::noise_db,
     "level of noise in that beam, in the pulse's -40 dB band", level_unit, cf::level},
    {"signal_excess_db", &CoverageLayer::signal_excess_db,
     "echo over what is detected half of the time", "dB"},
    {"detection_probability", &CoverageLayer::detection_probability,
     "probability that the echo is detected", "1"},
    {"two_way_loss_db", &CoverageLayer::two_way_loss_db,
     "transmission loss to the target and back to the array, without beams", "dB"},
    {"delay", &CoverageLayer::delay, "of the loudest pair of paths, since the ping", "s"},
    {"uncertainty_db", &CoverageLayer::uncertainty_db,
     "standard deviation of the echo's level in the cell: interference of its paths, and what rays "
     "cannot tell at edges; infinite: no ray comes",
     "dB"},
    {"reverberation_uncertainty_db", &CoverageLayer::reverberation_uncertainty_db,
     "standard deviation of reverberation's level over the cell and to its neighbours; infinite: "
     "it begins "
     "or ends there",
     "dB"}};

InputError wrong(const std::filesystem::path& path, const std::string& what, const std::string& got,
                 const std::string& expected) {
  return InputError({.where = path.string() + ": " + what, .got = got, .expected = expected});
}

/// Shares of a depth, by the area of the cells. \param certainty, probability  [bearings × ranges]
CoverageSummary::Layer summed(double depth, const std::vector<double>& ranges, std::size_t bearings,
                              const std::int8_t* certainty, const float* probability) {
  CoverageSummary::Layer layer{.depth = depth};
  double water = 0.0, detected = 0.0, shadow = 0.0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    std::size_t found = 0;
    for (std::size_t j = 0; j < bearings; ++j) {
      const std::size_t cell = j * ranges.size() + i;
      if (certainty[cell] == std::int8_t(CoverageCertainty::no_water)) continue;
      water += ranges[i];
      if (certainty[cell] == std::int8_t(CoverageCertainty::no_path)) shadow += ranges[i];
      if (!(probability[cell] >= 0.5F)) continue;
      detected += ranges[i];
      ++found;
    }
    if (2 * found >= bearings) layer.farthest = ranges[i];
  }
  layer.in_water = water > 0.0;
  if (layer.in_water) {
    layer.detected_share = detected / water;
    layer.no_path_share = shadow / water;
  }
  return layer;
}

/// Which maps hold a cell's middle.
void write_map_ends(Hdf5File& file, const EarthPlaces& earth, const Coverage& found,
                    const Area& area) {
  std::vector<std::int8_t> ends;
  for (const double bearing : found.bearings)
    for (const double range : found.ranges)
      ends.push_back(
          static_cast<std::int8_t>(area.end_at(found.receiver.x() + range * std::sin(bearing),
                                               found.receiver.y() + range * std::cos(bearing))));
  file.write<std::int8_t>("beyond_map", ends, {found.bearings.size(), found.ranges.size()});
  describe(
      file, "beyond_map",
      "which map ends before a cell's middle, and goes on with its edge: 0 none; 1 that of the "
      "sea floor; 2 that of the sound speed; 3 that of the seabed's kinds or of the wind");
  file.set_flags("beyond_map", {0, 1, 2, 3},
                 "on_the_maps beyond_bathymetry beyond_sound_speed beyond_seabed_or_wind");
  file.attach_scales("beyond_map", {"bearing", "range"});
  place_on_earth(file, earth.known(), "beyond_map");
}

/// Latitudes and longitudes of the cells' middles, and of the ends, where they are known.
void write_earth(Hdf5File& file, const EarthPlaces& earth, const Coverage& found) {
  if (!earth.known()) return;
  std::vector<Vec2> middles;
  for (const double bearing : found.bearings)
    for (const double range : found.ranges)
      middles.emplace_back(found.receiver.x() + range * std::sin(bearing),
                           found.receiver.y() + range * std::cos(bearing));
  write_on_earth(file, earth, "", "of a cell's middle", middles,
                 {found.bearings.size(), found.ranges.size()}, {"bearing", "range"});
  for (const auto& [name, place] :
       {std::pair{"source_position", found.source}, std::pair{"array_position", found.receiver}}) {
    const GeographicPlace there = earth.at(place.x(), place.y());
    file.set_attribute(name, "latitude_deg", there.latitude);
    file.set_attribute(name, "longitude_deg", there.longitude);
  }
}

}  // namespace

void write_coverage(Hdf5File& file, const Coverage& found, const Scenario& scenario) {
  const CoverageSettings& asked = found.settings;
  file.set_attribute("", "frequency_hz", found.frequency);
  file.set_attribute("", "transmitter", found.transmitter);
  file.set_attribute("", "array", found.array);
  file.set_attribute("", "ping", std::int64_t{asked.ping});
  file.set_attribute("", "ping_time_s", found.time);
  file.set_attribute("", "source_level_db", found.source_level_db);
  file.set_attribute("", "target_strength_db", asked.strength_db);
  file.set_attribute("", "fluctuation",
                     fluctuation_words[static_cast<std::size_t>(asked.fluctuation)]);
  file.set_attribute("", "false_alarm_probability", asked.false_alarm_probability);
  file.set_attribute("", "reference_cells", asked.reference_cells);
  file.set_attribute("", "detection_threshold_db", found.threshold_db);
  file.set_attribute("", "gain_over_noise_db", found.gain.noise_db);
  file.set_attribute("", "gain_over_reverberation_db", found.gain.reverberation_db);
  file.set_attribute("", "planes", std::int64_t{found.planes});
  file.set_attribute("", "surface_bounces", std::int64_t{found.followed.surface});
  file.set_attribute("", "bottom_bounces", std::int64_t{found.followed.bottom});

  std::vector<double> bearings, depths;
  for (const double bearing : found.bearings) bearings.push_back(degrees(bearing));
  for (const CoverageLayer& layer : found.layers) depths.push_back(layer.depth);
  write_scale(file, "depth", "depth", depths, "depth of the target, positive down", "m",
              cf::depth_axis);
  write_scale(file, "bearing", "bearing", bearings,
              "true bearing of a cell's middle from the array", "degree");
  write_scale(file, "range", "range", found.ranges,
              "horizontal distance of a cell's middle from the array", "m");
  write_scale<std::int32_t>(file, "xyz", "xyz", {0, 1, 2}, "0 east, 1 north, 2 depth");
  for (const auto& [name, place, meaning] :
       {std::tuple{"source_position", found.source, "east, north, depth of the transmitter"},
        std::tuple{"array_position", found.receiver,
                   "east, north, depth of the array: the middle of the picture"}}) {
    file.write<double>(name, std::vector<double>{place.x(), place.y(), place.z()}, {3});
    describe(file, name, meaning, "m");
    file.attach_scales(name, {"xyz"});
  }
  const EarthPlaces earth(scenario.origin, scenario.area.get());
  write_earth(file, earth, found);
  const Shape shape = {depths.size(), bearings.size(), found.ranges.size()};
  const std::vector<std::string> scales = {"depth", "bearing", "range"};
  for (const Column& column : columns) {
    std::vector<float> all;
    for (const CoverageLayer& layer : found.layers)
      all.insert(all.end(), (layer.*column.values).begin(), (layer.*column.values).end());
    file.write<float>(column.name, all, shape);
    describe(file, column.name, column.meaning, column.unit, column.cf);
    file.attach_scales(column.name, scales);
    place_on_earth(file, earth.known(), column.name);
  }
  std::vector<std::int8_t> certainty;
  for (const CoverageLayer& layer : found.layers)
    certainty.insert(certainty.end(), layer.certainty.begin(), layer.certainty.end());
  file.write<std::int8_t>("certainty", certainty, shape);
  describe(
      file, "certainty",
      "0 sure; 1 no_path: no ray comes there and back; 2 edge: paths begin or end beside it; 3 "
      "no_water: the depth is below the sea floor");
  file.set_flags("certainty", {0, 1, 2, 3}, "sure no_path edge no_water");
  file.attach_scales("certainty", scales);
  place_on_earth(file, earth.known(), "certainty");
  file.write<float>("bottom_depth", found.bottom_depth, {bearings.size(), found.ranges.size()});
  describe(file, "bottom_depth", "depth of the sea floor, positive down", "m", cf::sea_floor);
  file.attach_scales("bottom_depth", {"bearing", "range"});
  place_on_earth(file, earth.known(), "bottom_depth");
  if (scenario.area) write_map_ends(file, earth, found, *scenario.area);
  write_tracks(file, scenario);
}

void write_area(OutputFile&& to, const Coverage& found, const Scenario& scenario) {
  ResultOrigin origin = origin_of(scenario);
  origin.warnings.insert(origin.warnings.end(), found.warnings.begin(), found.warnings.end());
  Hdf5Output output(std::move(to));
  write_root(output.file(), "asdic area", origin);
  write_coverage(output.file(), found, scenario);
  output.finish();
}

CoverageSummary summary_of(const Coverage& found, const std::string& title) {
  CoverageSummary summary{.title = title,
                          .transmitter = found.transmitter,
                          .array = found.array,
                          .frequency = found.frequency,
                          .reach = found.settings.reach,
                          .bearings = found.bearings.size(),
                          .ranges = found.ranges.size(),
                          .layers = {}};
  for (const CoverageLayer& layer : found.layers)
    summary.layers.push_back(summed(layer.depth, found.ranges, found.bearings.size(),
                                    layer.certainty.data(), layer.detection_probability.data()));
  return summary;
}

CoverageSummary read_coverage_summary(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  if (const std::string type = file.attribute_or("", "filetype", ""); type != "asdic area")
    throw wrong(path, "filetype", type.empty() ? "none" : '"' + type + '"', "\"asdic area\"");
  const auto axis = [&](const char* name) {
    if (!file.has(name)) throw wrong(path, name, "nothing", "a dataset (docs/formats/area.md)");
    return file.read<double>(name);
  };
  const std::vector<double> depths = axis("depth"), bearings = axis("bearing"),
                            ranges = axis("range");
  CoverageSummary summary{.title = file.attribute_or("", "title", ""),
                          .transmitter = file.attribute_or("", "transmitter", ""),
                          .array = file.attribute_or("", "array", ""),
                          .frequency = file.has_attribute("", "frequency_hz")
                                           ? file.attribute_number("", "frequency_hz")
                                           : 0.0,
                          .reach = ranges.empty() ? 0.0 : ranges.back() + ranges.front(),
                          .bearings = bearings.size(),
                          .ranges = ranges.size(),
                          .layers = {}};
  const Shape shape = {depths.size(), bearings.size(), ranges.size()};
  for (const char* name : {"certainty", "detection_probability"})
    if (!file.has(name) || file.info(name).shape != shape)
      throw wrong(path, name, file.has(name) ? "a shape that does not fit its axes" : "nothing",
                  "(depth, bearing, range)");
  const auto certainty = file.read<std::int8_t>("certainty");
  const auto probability = file.read<float>("detection_probability");
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const std::size_t first = d * bearings.size() * ranges.size();
    summary.layers.push_back(summed(depths[d], ranges, bearings.size(), certainty.data() + first,
                                    probability.data() + first));
  }
  return summary;
}

}  // namespace asdic::detail
