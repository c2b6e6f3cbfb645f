#include "io/ping/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "io/ping/growing_table.h"
#include "io/ping/scale.h"

namespace asdic::ping_file {
namespace {

std::string_view text_of(PulseKind kind) {
  constexpr std::string_view names[] = {"cw", "lfm", "hfm", "file"};
  return names[static_cast<int>(kind)];
}

std::string_view text_of(PulseWindow window) {
  constexpr std::string_view names[] = {"none", "hann", "tukey"};
  return names[static_cast<int>(window)];
}

/// A boundary in the plane of the rays.
void write_line(Hdf5File& file, const std::string& side, const RayPaths::Line& line) {
  if (line.range.empty()) return;
  const std::string range = "rays/" + side + "_range", depth = "rays/" + side + "_depth";
  write_scale(file, range, "rays_" + side, line.range, "from the source, along the rays", "m");
  file.write<double>(depth, line.depth, {line.depth.size()});
  describe(file, depth, "of the " + side + " in the plane of the rays, positive down", "m");
  file.attach_scales(depth, {range});
}

}  // namespace

void write_root(Hdf5File& file, const Scenario& scenario, const Provenance& provenance) {
  file.set_attribute("", "filetype", "asdic ping");
  file.set_attribute("", "version", "1.0");
  file.set_attribute("", "title", scenario.title);
  file.set_attribute("", "program_version", provenance.program_version);
  file.set_attribute("", "build", provenance.build);
  file.set_attribute("", "seed", static_cast<std::int64_t>(scenario.seed));
  file.set_attribute("", "scenario_sha256", sha256(scenario.text));
  file.set_attribute("", "pings_requested", std::int64_t{scenario.pings.count});
  file.set_attribute("", "complete", std::int64_t{0});
  if (!scenario.overrides.empty()) file.set_attribute("", "overrides", scenario.overrides);
  file.write_text("scenario", scenario.text);
  describe(file, "scenario", "the scenario file, verbatim");

  std::vector<std::int32_t> channels(channels_of(scenario));
  std::iota(channels.begin(), channels.end(), 0);
  write_scale(file, "channel", "channel", channels, "number of the phone, from 0");
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

void write_replica(Hdf5File& file, const Scenario& scenario) {
  const Pulse pulse(scenario.pulse);
  const double rate = scenario.pings.sample_rate;
  const std::vector<float> samples = replica(pulse, rate);
  std::vector<double> time(samples.size());
  for (std::size_t i = 0; i < time.size(); ++i) time[i] = static_cast<double>(i) / rate;
  write_scale(file, "replica_time", "replica_sample", time, "after the pulse's leading edge", "s");
  file.write<float>("replica", samples, {samples.size()});
  describe(file, "replica", "transmitted pulse, unit peak before its window");
  file.attach_scales("replica", {"replica_time"});
  file.set_attribute("replica", "kind", text_of(scenario.pulse.kind));
  file.set_attribute("replica", "centre_frequency_hz", pulse.centre_frequency());
  file.set_attribute("replica", "bandwidth_hz", pulse.bandwidth_40db());
  file.set_attribute("replica", "duration_s", pulse.duration());
  file.set_attribute("replica", "window", text_of(scenario.pulse.window));
  file.set_attribute("replica", "source_level_db", scenario.transmitters[0].source_level_db);
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
  describe(file, "rays/depth", "depth, positive down", "m");
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

}  // namespace asdic::ping_file
