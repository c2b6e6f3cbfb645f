#include "io/ping/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/fields.h"
#include "core/fields_viewer.h"
#include "core/text.h"
#include "core/unit_text.h"
#include "io/files/digest.h"
#include "io/hdf5/environment_group.h"
#include "io/hdf5/scale.h"
#include "io/ping/growing_table.h"
#include "io/scenario/ocean.h"
#include "io/scenario/writer.h"
#include "io/text/material_text.h"
#include "raytrace/area/earth_places.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/ping/recorded_replica.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail::ping_file {
namespace {

/// A boundary in the plane of the rays.
void write_line(Hdf5File& file, const std::string& side, const RayPaths::Line& line) {
  if (line.range.empty()) return;
  const std::string range = "rays/" + side + "_range", depth = "rays/" + side + "_depth";
  write_scale(file, range, "rays_" + side, line.range, "from the source, along the rays", "m",
              cf::range_axis);
  file.write<double>(depth, line.depth, {line.depth.size()});
  describe(file, depth, "of the " + side + " in the plane of the rays, positive down", "m",
           cf::of_boundary(side));
  file.attach_scales(depth, {range});
}

}  // namespace

void write_root(Hdf5File& file, const Scenario& scenario, const Provenance& provenance) {
  write_filetype(file, "asdic ping", "3.3");
  file.set_attribute("", "title", scenario.title);
  file.set_attribute("", "program_version", provenance.program_version);
  file.set_attribute("", "build", provenance.build);
  file.set_attribute("", "seed", static_cast<std::int64_t>(scenario.seed));
  // One that was not read from a file is written as one.
  const std::string text = scenario.text.empty() ? to_toml(scenario) : scenario.text;
  file.set_attribute("", "scenario_sha256", sha256(text));
  file.set_attribute(
      "", "pings_requested",
      static_cast<std::int64_t>(scenario.pings.count) * std::ssize(scenario.transmitters));
  file.set_attribute("", "complete", std::int64_t{0});
  if (!scenario.overrides.empty()) file.set_attribute("", "overrides", scenario.overrides);
  if (!scenario.notes.empty()) file.set_attribute("", "warnings", scenario.notes);
  write_origin(file, attributes_of(scenario.origin));
  file.write_text("scenario", text);
  describe(file, "scenario", "the scenario file, verbatim");

  std::vector<std::int32_t> channels(channels_of(scenario));
  std::iota(channels.begin(), channels.end(), 0);
  write_scale(file, "channel", "channel", channels, "number of the phone, from 0");
  std::vector<std::int32_t> array_of_channel;
  std::vector<std::string> arrays, transmitters;
  for (std::size_t a = 0; a < scenario.arrays.size(); ++a) {
    arrays.push_back(scenario.arrays[a].name);
    array_of_channel.insert(array_of_channel.end(), scenario.arrays[a].phones.size(),
                            static_cast<std::int32_t>(a));
  }
  for (const Transmitter& transmitter : scenario.transmitters)
    transmitters.push_back(transmitter.name);
  file.write<std::int32_t>("channel_array", array_of_channel, {array_of_channel.size()});
  describe(file, "channel_array", "number of the channel's array, from 0");
  file.attach_scales("channel_array", {"channel"});
  file.set_attribute("channel_array", "names", arrays);
  file.set_attribute("", "transmitters", transmitters);
  write_scale<std::int32_t>(file, "xyz", "xyz", {0, 1, 2}, "0 east, 1 north, 2 depth");
  if (!scenario.targets.empty()) {
    std::vector<std::int32_t> targets(scenario.targets.size());
    std::iota(targets.begin(), targets.end(), 0);
    write_scale(file, "target_index", "target", targets, "number of the target, from 0");
    std::vector<std::string> names;
    for (const Target& target : scenario.targets) names.push_back(target.name);
    file.set_attribute("target_index", "names", names);
  }
  file.make_group("run");
  file.set_attribute("run", "host", provenance.host);
  file.set_attribute("run", "started", provenance.started);
  file.set_attribute("run", "cpu", provenance.cpu);
  file.set_attribute("run", "library_versions", provenance.library_versions);
  file.set_attribute("run", "threads", std::int64_t{provenance.threads});
}

/// The pulse of one transmitter as a matched filter needs it: real at the phones' rate, or complex
/// about the baseband's carrier.
void write_replica(Hdf5File& file, const Scenario& scenario, int transmitter, SampleTimes times) {
  const PulseSettings& settings = pulse_of(scenario, transmitter);
  const Pulse pulse(settings);
  const double rate = recorded_rate(scenario), carrier = recorded_carrier(scenario);
  const std::string suffix = transmitter == 0 ? "" : "_" + std::to_string(transmitter);
  const std::string name = "replica" + suffix;
  const std::vector<float> samples = recorded_replica(scenario, transmitter);
  const std::size_t length = carrier > 0.0 ? samples.size() / 2 : samples.size();
  const TimeAxis axis{.dimension = "replica_sample" + suffix,
                      .coordinate = "replica_time" + suffix,
                      .long_name = "after the pulse's leading edge",
                      .start = 0.0,
                      .step = 1.0 / rate,
                      .size = length};
  Shape shape{length};
  std::vector<std::string> scales{write_time_axis(file, axis, times == SampleTimes::written_out)};
  if (carrier > 0.0) {
    shape.push_back(2);
    scales.emplace_back("iq");
  }
  file.write<float>(name, samples, shape);
  describe(file, name,
           carrier > 0.0 ? "transmitted pulse, complex baseband, unit peak before its window"
                         : "transmitted pulse, unit peak before its window",
           "1");
  file.attach_scales(name, scales);
  write_times(file, name, axis);
  file.set_attribute(name, "kind", name_of(settings.waveform));
  file.set_attribute(name, "centre_frequency_hz", pulse.centre_frequency());
  file.set_attribute(name, "bandwidth_hz", pulse.bandwidth_40db());
  const auto through = frequencies_of(settings.waveform, settings.duration);
  file.set_attribute(
      name, "sweep_hz",
      through ? through->highest - through->lowest : std::numeric_limits<double>::quiet_NaN());
  file.set_attribute(name, "duration_s", pulse.duration());
  file.set_attribute(name, "window", word_of(settings.window));
  file.set_attribute(name, "source_level_db",
                     scenario.transmitters[static_cast<std::size_t>(transmitter)].source_level_db);
}

void write_replicas(Hdf5File& file, const Scenario& scenario, SampleTimes times) {
  if (recorded_carrier(scenario) > 0.0)
    write_scale<std::int32_t>(file, "iq", "iq", {0, 1}, "0 real part, 1 imaginary part");
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t)
    write_replica(file, scenario, static_cast<int>(t), times);
}

void write_rays(Hdf5File& file, const RayPaths& rays) {
  const std::size_t n = rays.paths.size();
  std::size_t points = 0;
  for (const auto& path : rays.paths)
    points = std::max({points, path.range.size(), path.depth.size()});
  if (n == 0 || points == 0) return;
  std::vector<double> elevation, range(n * points, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> depth = range;
  std::vector<std::int32_t> kind, ray(n), point(points);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& path = rays.paths[i];
    const auto line = static_cast<std::ptrdiff_t>(i * points);
    std::copy(path.range.begin(), path.range.end(), range.begin() + line);
    std::copy(path.depth.begin(), path.depth.end(), depth.begin() + line);
    elevation.push_back(degrees(path.launch_elevation));
    kind.push_back(static_cast<std::int32_t>(path.kind));
  }
  std::iota(ray.begin(), ray.end(), 0);
  std::iota(point.begin(), point.end(), 0);
  write_scale(file, "rays/ray", "ray", ray, "number of the ray");
  write_scale(file, "rays/point", "point", point, "number of the point along a ray");
  file.write<double>("rays/launch_elevation_deg", elevation, {n});
  describe(file, "rays/launch_elevation_deg", "elevation at the source, positive up", "degree");
  file.write<std::int32_t>("rays/kind", kind, {n});
  describe(file, "rays/kind", "0 fan of the beam, 1 eigenray to a target");
  file.write<double>("rays/range", range, {n, points});
  describe(file, "rays/range", "horizontal distance from the source", "m");
  file.write<double>("rays/depth", depth, {n, points});
  describe(file, "rays/depth", "depth, positive down", "m", cf::depth);
  for (const char* name : {"rays/launch_elevation_deg", "rays/kind"})
    file.attach_scales(name, {"rays/ray"});
  for (const char* name : {"rays/range", "rays/depth"})
    file.attach_scales(name, {"rays/ray", "rays/point"});
  write_line(file, "bottom", rays.bottom);
  write_line(file, "surface", rays.surface);
  if (rays.bearing) file.set_attribute("rays", "bearing_deg", compass_degrees(*rays.bearing));
  if (rays.hit_range.empty()) return;
  std::vector<std::int32_t> hit(rays.hit_range.size());
  std::iota(hit.begin(), hit.end(), 0);
  write_scale(file, "rays/hit", "hit", hit, "number of the meeting");
  file.write<double>("rays/hit_range", rays.hit_range, {hit.size()});
  describe(file, "rays/hit_range", "where the fan meets the surface", "m");
  file.attach_scales("rays/hit_range", {"rays/hit"});
}

namespace {

/// Writes the numbers of described structs as attributes of a group, as they are in the structs.
class NumberAttributes final : public FieldsViewer {
 public:
  NumberAttributes(Hdf5File& file, std::string group, std::string prefix)
      : file_(file), group_(std::move(group)), prefix_(std::move(prefix)) {}

 private:
  void number(const Setting& s, const Quantity&, double& value, bool*) override {
    file_.set_attribute(group_, prefix_ + std::string(s.key.name), value);
  }

  Hdf5File& file_;
  std::string group_, prefix_;
};

/// A choice and its numbers in words: "francois-garrison, 8 degC, 35 psu, pH 8, 1000 m".
class Words final : public FieldsViewer {
 public:
  std::string text;

 private:
  void alternatives(const Setting&, const OneOf& one) override {
    text += one.names[one.index];
    one.chosen().describe(*this);
  }
  void number(const Setting&, const Quantity& q, double& value, bool*) override {
    const std::string number = to_text(value);
    text +=
        ", " + (q.unit.empty() ? std::string(q.noun) + " " + number : number + " " + unit_of(q));
  }
};

std::string absorption_of(const Environment& ocean) {
  Words words;
  scenario::describe_absorption(words, ocean);
  return words.text;
}

std::string interpolation_of(const Environment& ocean) {
  if (ocean.section) return "section";
  if (const auto& munk = ocean.water.munk_parameters())
    return "munk, axis " + to_text(munk->axis_speed) + " m/s at " + to_text(munk->axis_depth) +
           " m, scale " + to_text(munk->scale_depth) + " m, perturbation " +
           to_text(munk->perturbation);
  if (ocean.water.depths().size() == 1) return "isovelocity";
  return std::string(name(ocean.water.interpolation()));
}

template <class T>
std::vector<T> vector_of(std::span<const T> values) {
  return {values.begin(), values.end()};
}

/// The nodes of a boundary that is not flat. \param side  "surface" or "bottom"
void write_shape(Hdf5File& file, const std::string& side, const BoundaryShape& shape) {
  const std::string range = "environment/" + side + "_range",
                    depth = "environment/" + side + "_depth";
  write_scale(file, range, side + "_node", vector_of(shape.ranges()), "along the transect", "m",
              cf::range_axis);
  file.write<double>(depth, vector_of(shape.depths()), {shape.depths().size()});
  describe(file, depth, "of the " + side + " at its nodes, positive down", "m",
           cf::of_boundary(side));
  file.attach_scales(depth, {range});
  file.set_attribute(depth, "interpolation", name(shape.interpolation()));
  if (shape.materials().empty()) return;
  std::vector<std::string> materials;
  for (const BoundaryMaterial& material : shape.materials())
    materials.push_back(material_text(material));
  file.set_attribute(depth, "materials", materials);
}

void write_section(Hdf5File& file, const SoundSpeedSection& section) {
  write_scale(file, "environment/section_range", "section_range", vector_of(section.ranges()),
              "along the transect", "m", cf::range_axis);
  write_scale(file, "environment/section_depth", "section_depth", vector_of(section.depths()),
              "depth, positive down", "m", cf::depth_axis);
  file.write<double>("environment/section_sound_speed", vector_of(section.speeds()),
                     {section.ranges().size(), section.depths().size()});
  describe(file, "environment/section_sound_speed", "speed of sound", "m/s", cf::sound_speed);
  file.attach_scales("environment/section_sound_speed",
                     {"environment/section_range", "environment/section_depth"});
}

/// Longitudes along the middle row of that grid, latitudes along its middle column: ticks of a map.
void write_area_degrees(Hdf5File& file, const EarthPlaces& earth, const Vec2& middle,
                        const std::vector<double>& east, const std::vector<double>& north) {
  if (!earth.known()) return;
  std::vector<double> longitude, latitude;
  for (const double x : east) longitude.push_back(earth.at(x, middle.y()).longitude);
  for (const double y : north) latitude.push_back(earth.at(middle.x(), y).latitude);
  const std::string along = "environment/area_longitude", up = "environment/area_latitude";
  file.write<double>(along, longitude, {longitude.size()});
  describe(file, along, "longitude due east and west of the platform's first place", "degrees_east",
           cf::longitude);
  file.attach_scales(along, {"environment/area_east"});
  file.write<double>(up, latitude, {latitude.size()});
  describe(file, up, "latitude due north and south of the platform's first place", "degrees_north",
           cf::latitude);
  file.attach_scales(up, {"environment/area_north"});
}

/// All that varies along the transect, and where that lies.
void write_transect(Hdf5File& file, const Scenario& scenario) {
  const Environment& ocean = scenario.environment;
  if (!varies_with_range(ocean)) return;
  file.set_attribute("environment", "transect_x_m", scenario.transect.x);
  file.set_attribute("environment", "transect_y_m", scenario.transect.y);
  file.set_attribute("environment", "transect_bearing_deg",
                     compass_degrees(scenario.transect.bearing));
  if (scenario.area) {
    const double reach = scenario.area->reach_on_map({scenario.transect.x, scenario.transect.y},
                                                     scenario.transect.bearing, reach_of_area);
    if (reach < reach_of_area) file.set_attribute("environment", "map_end_m", reach);
  }
  if (ocean.section) write_section(file, *ocean.section);
  if (ocean.surface.shape) write_shape(file, "surface", *ocean.surface.shape);
  if (ocean.bottom.shape) write_shape(file, "bottom", *ocean.bottom.shape);
}

}  // namespace

void write_area(Hdf5File& file, const Scenario& scenario) {
  const Area& area = *scenario.area;
  const Vec2 middle = scenario.platforms[0].track.at(0.0).position.head<2>();
  double away = 0.0;  // that a platform ever is
  for (const Platform& platform : scenario.platforms)
    for (int ping = 0; ping < scenario.pings.count; ++ping) {
      const Vec3 place = platform.track.at(ping * scenario.pings.interval).position;
      away = std::max(away, (place.head<2>() - middle).norm());
    }
  const double heard = away + 0.5 * 1500.0 * end_of_record(scenario);
  const double step = std::max(0.1 * area.spacing(middle), heard / 100.0);
  const auto lines = static_cast<int>(std::ceil(heard / step));
  std::vector<double> east, north, depth;
  for (int i = -lines; i <= lines; ++i) {
    east.push_back(middle.x() + i * step);
    north.push_back(middle.y() + i * step);
  }
  for (const double y : north)
    for (const double x : east)
      depth.push_back(area.floor().covers(x, y) ? area.bottom_depth(x, y) : std::nan(""));
  write_scale(file, "environment/area_east", "area_east", east, "east on the map", "m");
  write_scale(file, "environment/area_north", "area_north", north, "north on the map", "m");
  file.write<double>("environment/area_depth", depth, {north.size(), east.size()});
  describe(file, "environment/area_depth",
           "depth of the sea floor, below 0 on land, NaN beyond the map", "m");
  file.attach_scales("environment/area_depth", {"environment/area_north", "environment/area_east"});
  file.set_attribute("environment", "area_bathymetry", area.floor().name());
  write_area_degrees(file, {scenario.origin, &area}, middle, east, north);
}

void write_environment(Hdf5File& file, const Scenario& scenario) {
  const Environment& ocean = scenario.environment;
  const OceanOnMap paths = ocean_on_map(scenario);
  Vec3 place = scenario.platforms[0].track.at(0.0).position;
  const double surface = paths.surface_depth(place), bottom = paths.bottom_depth(place);
  constexpr std::size_t points = 501;
  std::vector<double> depth, speed;
  for (std::size_t i = 0; i < points; ++i) {
    depth.push_back(surface + (bottom - surface) * static_cast<double>(i) / (points - 1.0));
    speed.push_back(paths.speed_at({place.x(), place.y(), depth.back()}));
  }
  write_scale(file, "environment/depth", "depth", depth, "depth, positive down", "m",
              cf::depth_axis);
  file.write<double>("environment/sound_speed", speed, {points});
  describe(file, "environment/sound_speed", "speed of sound at the platform's first place", "m/s",
           cf::sound_speed);
  file.attach_scales("environment/sound_speed", {"environment/depth"});

  const std::string group = "environment";
  file.set_attribute(group, "surface", material_text(ocean.surface.material));
  file.set_attribute(group, "bottom", material_text(ocean.bottom.material));
  file.set_attribute(group, "bottom_depth_m", bottom);
  file.set_attribute(group, "wind_speed_mps", scenario.wind_speed);
  file.set_attribute(group, "absorption", absorption_of(ocean));
  file.set_attribute(group, "interpolation", interpolation_of(ocean));
  write_transect(file, scenario);
  if (scenario.area) write_area(file, scenario);
  const auto write_law = [&](const auto& law, const std::string& prefix) {
    file.set_attribute(group, prefix + "_model", std::string(name_of(law)));
    NumberAttributes attributes(file, group, prefix + "_");
    std::visit([&](const auto& one) { look(one, attributes); }, law);
  };
  write_law(scenario.reverberation.surface, "scattering");
  if (scenario.reverberation.bottom) write_law(*scenario.reverberation.bottom, "bottom_scattering");
  const double wavelength = paths.speed_at(place) / Pulse(scenario.pulse).centre_frequency();
  file.set_attribute(group, "transmitter_line_length_m",
                     BeamPattern(scenario.transmitters[0], wavelength).line_length());
}

}  // namespace asdic::detail::ping_file
