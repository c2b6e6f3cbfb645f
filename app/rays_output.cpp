#include "app/rays_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "app/console.h"
#include "core/units.h"
#include "io/bellhop/results.h"
#include "io/hdf5/earth.h"
#include "io/hdf5/environment_group.h"
#include "io/ping/growing_table.h"

namespace asdic::detail::app {
namespace {

/// Ranges of the first few meetings with the surface [km].
std::string hits(const RayPath& ray) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, ray.surface_hits.size()); ++i) {
    if (i > 0) text += ' ';
    text += number(ray.surface_hits[i] / 1000.0, 2);
  }
  if (ray.surface_hits.size() > most) text += " ...";
  return text;
}

/// The datasets of /rays: a column has a value a ray, a matrix a line a ray, padded with NaN.
class RaysGroup {
 public:
  RaysGroup(Hdf5File& file, const std::vector<RayPath>& rays) : file_(file), rays_(rays) {
    scale("ray", rays.size());
  }

  void scale(const std::string& dimension, std::size_t n) {
    std::vector<std::int32_t> numbers(n);
    std::iota(numbers.begin(), numbers.end(), 0);
    const std::string dataset = path(dimension);
    file_.write<std::int32_t>(dataset, numbers, {n});
    describe(file_, dataset, "number, from 0");
    file_.make_scale(dataset, dimension);
  }

  template <class T>
  void column(const std::string& name, T (*value)(const RayPath&), const std::string& long_name,
              const std::string& units = "") {
    std::vector<T> values(rays_.size());
    std::transform(rays_.begin(), rays_.end(), values.begin(), value);
    file_.write<T>(path(name), values, {rays_.size()});
    describe(file_, path(name), long_name, units);
    file_.attach_scales(path(name), {path("ray")});
  }

  /// \param value  (ray, i), for i below size(ray)
  void matrix(const std::string& name, const std::string& dimension, std::size_t n,
              std::size_t (*size)(const RayPath&), double (*value)(const RayPath&, std::size_t),
              const std::string& long_name, const std::string& units, const Meaning& meaning = {}) {
    std::vector<double> values(rays_.size() * n, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < rays_.size(); ++i)
      for (std::size_t j = 0; j < size(rays_[i]); ++j) values[i * n + j] = value(rays_[i], j);
    file_.write<double>(path(name), values, {rays_.size(), n});
    describe(file_, path(name), long_name, units, meaning);
    file_.attach_scales(path(name), {path("ray"), path(dimension)});
  }

 private:
  static std::string path(const std::string& name) { return fmt::format("rays/{}", name); }

  Hdf5File& file_;
  const std::vector<RayPath>& rays_;
};

}  // namespace

std::string rays_table(const RaysResult& result) {
  Table table({{"launch", "deg"},
               {"final", "deg"},
               {"range", "km"},
               {"depth", "m"},
               {"time", "s"},
               {"length", "km"},
               {"surface"},
               {"bottom"},
               {"turns"},
               {"meets the surface at", "km", true}});
  for (const RayPath& ray : result.rays()) {
    const RayPoint& end = ray.points.back();
    table.row({number(degrees(ray.launch_elevation), 3), number(degrees(ray.final_elevation), 3),
               number(end.range / 1000.0, 3), number(end.depth, 1), number(end.time, 4),
               number(ray.path_length / 1000.0, 3), std::to_string(ray.surface_bounces),
               std::to_string(ray.bottom_bounces), std::to_string(ray.turns), hits(ray)});
  }
  return table.text();
}

void write_rays_file(OutputFile&& to, const RaysResult& result) {
  if (to.target().extension() == ".ray") {
    bellhop::write_ray_file(std::move(to),
                            bellhop::ray_file(result.run_case, {.rays = result.rays_of_source,
                                                                .beams = result.rays().size()}));
    return;
  }
  double least_range = 0.0, greatest_range = 0.0;
  for (const RayPath& ray : result.rays())
    for (const RayPoint& point : ray.points) {
      least_range = std::min(least_range, point.range);
      greatest_range = std::max(greatest_range, point.range);
    }
  Hdf5Output output(std::move(to));
  Hdf5File& file = output.file();
  write_root(file, "asdic rays", result.origin);
  file.set_attribute("", "source_depth_m", result.source_depth());
  // What a .ray holds in its header: the file may become one (asdic convert).
  const bellhop::RayFile header = bellhop::ray_file(result.run_case, {});
  file.set_attribute("", "frequency_hz", header.frequency);
  file.set_attribute("", "surface_depth_m", header.surface_depth);
  file.set_attribute("", "bottom_depth_m", header.bottom_depth);
  write_environment_group(file, plane_of(result.run_case), least_range, greatest_range,
                          reach_on_map(result.run_case, greatest_range));

  RaysGroup group(file, result.rays());
  group.column<double>(
      "launch_elevation_deg", [](const RayPath& r) { return degrees(r.launch_elevation); },
      "elevation at launch, positive up", "degree");
  group.column<double>(
      "final_elevation_deg", [](const RayPath& r) { return degrees(r.final_elevation); },
      "elevation of travel at the end, positive up", "degree");
  group.column<double>(
      "travel_time", [](const RayPath& r) { return r.points.back().time; },
      "travel time to the end", "s");
  group.column<double>(
      "path_length", [](const RayPath& r) { return r.path_length; }, "length along the ray", "m");
  group.column<std::int32_t>(
      "surface_bounces", [](const RayPath& r) { return r.surface_bounces; },
      "reflections at the surface");
  group.column<std::int32_t>(
      "bottom_bounces", [](const RayPath& r) { return r.bottom_bounces; },
      "reflections at the bottom");
  group.column<std::int32_t>(
      "turns", [](const RayPath& r) { return r.turns; }, "turning points between the boundaries");

  std::size_t points = 1, hits = 1;
  for (const RayPath& ray : result.rays()) {
    points = std::max(points, ray.points.size());
    hits = std::max(hits, ray.surface_hits.size());
  }
  group.scale("point", points);
  group.scale("hit", hits);
  const auto point_count = [](const RayPath& r) { return r.points.size(); };
  group.matrix(
      "range", "point", points, point_count,
      [](const RayPath& r, std::size_t i) { return r.points[i].range; },
      "horizontal distance from the source", "m");
  group.matrix(
      "depth", "point", points, point_count,
      [](const RayPath& r, std::size_t i) { return r.points[i].depth; }, "depth, positive down",
      "m", cf::depth);
  group.matrix(
      "time", "point", points, point_count,
      [](const RayPath& r, std::size_t i) { return r.points[i].time; }, "travel time", "s");
  group.matrix(
      "surface_hit", "hit", hits, [](const RayPath& r) { return r.surface_hits.size(); },
      [](const RayPath& r, std::size_t i) { return r.surface_hits[i]; },
      "ranges where the ray meets the surface", "m");
  const EarthLine earth(result.run_case);
  write_on_earth(file, earth, "rays/", "of the point", file.read<double>("rays/range"),
                 {result.rays().size(), points}, {"rays/ray", "rays/point"});
  for (const char* name : {"range", "depth", "time"})
    place_on_earth(file, earth.known(), std::string("rays/") + name);
  output.finish();
}

}  // namespace asdic::detail::app
