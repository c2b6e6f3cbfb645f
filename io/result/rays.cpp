// Rays of tables.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "io/hdf5/earth.h"
#include "io/hdf5/scale.h"
#include "io/result/tables.h"

namespace asdic::detail::result_tables {
namespace {

using bellhop::RayFile;

void write_numbers(Hdf5File& file, const std::string& name, std::size_t n) {
  std::vector<std::int32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  write_scale(file, "rays/" + name, name, numbers, "number, from 0");
}

template <class T>
void write(Hdf5File& file, const std::string& name, const std::vector<T>& values,
           const Shape& shape, const std::string& long_name, const std::string& units = "",
           const Meaning& meaning = {}) {
  file.write<T>("rays/" + name, values, shape);
  describe(file, "rays/" + name, long_name, units, meaning);
  file.attach_scales("rays/" + name, shape.size() == 1
                                         ? std::vector<std::string>{"rays/ray"}
                                         : std::vector<std::string>{"rays/ray", "rays/point"});
}

constexpr const char* numbers_of_header[] = {"sources_x", "sources_y", "sources_z", "angles"};

int* number_of_header(RayFile& file, std::size_t i) {
  return std::array{&file.sources_x, &file.sources_y, &file.sources_z, &file.angles}[i];
}

}  // namespace

void write_rays(Hdf5File& file, const RayFile& rays, const EarthLine& earth) {
  RayFile header = {.sources_x = rays.sources_x,
                    .sources_y = rays.sources_y,
                    .sources_z = rays.sources_z,
                    .angles = rays.angles};
  for (std::size_t i = 0; i < std::size(numbers_of_header); ++i)
    file.set_attribute("", numbers_of_header[i], std::int64_t{*number_of_header(header, i)});
  file.set_attribute("", "frequency_hz", rays.frequency);
  file.set_attribute("", "surface_depth_m", rays.surface_depth);
  file.set_attribute("", "bottom_depth_m", rays.bottom_depth);
  const std::size_t n = rays.rays.size();
  std::size_t points = 1;
  for (const RayFile::Ray& ray : rays.rays) points = std::max(points, ray.range.size());
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> launch, range(n * points, nothing), depth(n * points, nothing);
  std::vector<std::int32_t> surface, bottom;
  for (std::size_t i = 0; i < n; ++i) {
    const RayFile::Ray& ray = rays.rays[i];
    launch.push_back(-ray.launch_angle_deg);
    surface.push_back(ray.surface_bounces);
    bottom.push_back(ray.bottom_bounces);
    std::copy(ray.range.begin(), ray.range.end(), range.begin() + std::ptrdiff_t(i * points));
    std::copy(ray.depth.begin(), ray.depth.end(), depth.begin() + std::ptrdiff_t(i * points));
  }
  write_numbers(file, "ray", n);
  write_numbers(file, "point", points);
  write(file, "launch_elevation_deg", launch, {n}, "elevation at launch, positive up", "degree");
  write(file, "surface_bounces", surface, {n}, "reflections at the surface");
  write(file, "bottom_bounces", bottom, {n}, "reflections at the bottom");
  write(file, "range", range, {n, points}, "horizontal distance from the source", "m");
  write(file, "depth", depth, {n, points}, "depth, positive down", "m", cf::depth);
  write_on_earth(file, earth, "rays/", "of the point", range, {n, points},
                 {"rays/ray", "rays/point"});
  for (const char* name : {"rays/range", "rays/depth"}) place_on_earth(file, earth.known(), name);
}

RayFile read_rays(const Hdf5File& file) {
  const auto fault = [&](const std::string& name, const std::string& got) {
    return InputError({.where = file.path().string() + ": rays/" + name,
                       .got = got,
                       .expected = "a dataset as in docs/formats/rays.md"});
  };
  const auto read = [&](const std::string& name) {
    if (!file.has("rays/" + name)) throw fault(name, "nothing");
    return file.read<double>("rays/" + name);
  };
  RayFile result;
  const auto attribute = [&](const char* key, double otherwise) {
    return file.has_attribute("", key) ? file.attribute_number("", key) : otherwise;
  };
  if (file.has_attribute("", "title")) result.title = file.attribute_text("", "title");
  result.frequency = attribute("frequency_hz", 0.0);
  result.surface_depth = attribute("surface_depth_m", 0.0);
  const auto launch = read("launch_elevation_deg"), surface = read("surface_bounces"),
             bottom = read("bottom_bounces"), range = read("range"), depth = read("depth");
  const Shape shape = file.info("rays/range").shape;
  if (shape.size() != 2 || shape[0] != launch.size() || range.size() != depth.size() ||
      surface.size() != launch.size() || bottom.size() != launch.size())
    throw fault("range", "shapes that do not fit");
  double deepest = 0.0;
  for (std::size_t i = 0; i < launch.size(); ++i) {
    RayFile::Ray ray{.launch_angle_deg = -launch[i],
                     .surface_bounces = static_cast<int>(surface[i]),
                     .bottom_bounces = static_cast<int>(bottom[i])};
    for (std::size_t k = i * shape[1]; k < (i + 1) * shape[1]; ++k) {
      if (!std::isfinite(range[k]) || !std::isfinite(depth[k])) continue;
      ray.range.push_back(range[k]);
      ray.depth.push_back(depth[k]);
      deepest = std::max(deepest, depth[k]);
    }
    result.rays.push_back(std::move(ray));
  }
  result.angles = static_cast<int>(result.rays.size());
  for (std::size_t i = 0; i < std::size(numbers_of_header); ++i) {
    int& number = *number_of_header(result, i);
    number = static_cast<int>(attribute(numbers_of_header[i], number));
  }
  result.bottom_depth = attribute("bottom_depth_m", deepest);
  return result;
}

}  // namespace asdic::detail::result_tables
