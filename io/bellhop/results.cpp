#include "io/bellhop/results.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace asdic::detail::bellhop {
namespace {

std::string title_of(const PropagationCase& run_case) { return "BELLHOP- " + run_case.title; }

void check_size(std::size_t found, const PropagationCase& run_case, const char* what,
                std::size_t planes = 1) {
  const std::size_t expected = planes * run_case.source_depths.size() * run_case.receivers.size();
  if (found != expected)
    throw InputError({.where = what,
                      .got = std::to_string(found) + " receivers",
                      .expected = std::to_string(expected) + " receivers"});
}

/// Degrees positive down of an elevation; 0 stays +0.
double declination(double elevation) noexcept { return 0.0 - degrees(elevation); }

/// An angle between ±π beside `near`, plus the turns that `near` has.
double unwrapped(double phase, double near) noexcept {
  return near + std::remainder(phase - near, 2.0 * pi);
}

ArrivalRow row_of(const Arrival& arrival, double frequency) {
  const double nepers = arrival.absorption_db / db_from_amplitude(std::exp(1.0));
  // What the path has gone through, for the number of whole turns: −1 at the surface, i at a
  // caustic.
  const double sign = arrival.surface_bounces % 2 == 0 ? 1.0 : -1.0;
  const double history = pi * arrival.surface_bounces + 0.5 * pi * arrival.caustics +
                         std::arg(sign * arrival.reflection);
  return {.amplitude = std::abs(arrival.amplitude) * std::exp(nepers),
          .phase_deg = degrees(unwrapped(std::arg(arrival.amplitude), history)),
          .delay = arrival.delay,
          .delay_imaginary = 0.0 - nepers / (2.0 * pi * frequency),
          .launch_angle_deg = declination(arrival.launch_elevation),
          .arrival_angle_deg = declination(arrival.arrival_elevation),
          .surface_bounces = arrival.surface_bounces,
          .bottom_bounces = arrival.bottom_bounces,
          .launch_deflection_deg = degrees(arrival.launch_deflection),
          .arrival_deflection_deg = degrees(arrival.arrival_deflection)};
}

}  // namespace

namespace {

MapPlaces places_of(const Input& input) {
  if (!input.map) return {};
  return {.source_x = input.map->source_x,
          .source_y = input.map->source_y,
          .azimuths_deg = input.map->azimuths_deg};
}

ShadeFile shade_file_of(const PropagationCase& run_case, PropagationResult result, Dialect dialect,
                        const MapPlaces& map) {
  check_size(result.field.size(), run_case, "field", map.planes());
  ShadeFile file{.title = title_of(run_case),
                 .irregular = run_case.receivers.irregular,
                 .frequency = run_case.frequency,
                 .source_depths = run_case.source_depths,
                 .receiver_depths = run_case.receivers.depths,
                 .receiver_ranges = run_case.receivers.ranges,
                 .pressure = std::move(result.field),
                 .dialect = dialect,
                 .map = map};
  if (run_case.beams.source == SourceKind::point)
    for (std::complex<float>& p : file.pressure) p = -p;
  return file;
}

ArrivalsFile arrivals_file_of(const PropagationCase& run_case, const PropagationResult& result,
                              bool binary, Dialect dialect, const MapPlaces& map) {
  check_size(result.arrivals.size(), run_case, "arrivals", map.planes());
  ArrivalsFile file{.binary = binary,
                    .frequency = run_case.frequency,
                    .source_depths = run_case.source_depths,
                    .receiver_depths = run_case.receivers.depths,
                    .receiver_ranges = run_case.receivers.ranges,
                    .irregular = run_case.receivers.irregular,
                    .dialect = dialect,
                    .map = map};
  file.arrivals.reserve(result.arrivals.size());
  for (const Arrivals& arrivals : result.arrivals) {
    std::vector<ArrivalRow>& rows = file.arrivals.emplace_back();
    rows.reserve(arrivals.size());
    for (const Arrival& arrival : arrivals) rows.push_back(row_of(arrival, run_case.frequency));
  }
  return file;
}

}  // namespace

ShadeFile shade_file(const PropagationCase& run_case, PropagationResult result, Dialect dialect) {
  return shade_file_of(run_case, std::move(result), dialect, {});
}

ShadeFile shade_file(const Input& input, PropagationResult result, Dialect dialect) {
  return shade_file_of(input.run_case, std::move(result), dialect, places_of(input));
}

ArrivalsFile arrivals_file(const PropagationCase& run_case, const PropagationResult& result,
                           bool binary, Dialect dialect) {
  return arrivals_file_of(run_case, result, binary, dialect, {});
}

ArrivalsFile arrivals_file(const Input& input, const PropagationResult& result, Dialect dialect) {
  ArrivalsFile file =
      arrivals_file_of(input.run_case, result, input.binary_arrivals, dialect, places_of(input));
  file.three_dimensional = input.map.has_value();
  return file;
}

RayFile ray_file(const PropagationCase& run_case, const PropagationResult& result) {
  const Environment& ocean = run_case.environment;
  const std::span<const double> nodes = ocean.water.depths();
  RayFile file{.title = title_of(run_case),
               .frequency = run_case.frequency,
               .sources_z = int(run_case.source_depths.size()),
               .angles = int(result.beams),
               // of the profile, wherever the boundaries are
               .surface_depth = nodes.empty() ? ocean.surface.depth : nodes.front(),
               .bottom_depth = nodes.empty() ? ocean.bottom.depth : nodes.back()};
  for (const std::vector<RayPath>& rays : result.rays) {
    std::vector<const RayPath*> order;
    for (const RayPath& ray : rays) order.push_back(&ray);
    std::stable_sort(order.begin(), order.end(), [](const RayPath* a, const RayPath* b) {
      return a->launch_elevation > b->launch_elevation;
    });
    for (const RayPath* ray : order) {
      RayFile::Ray& out = file.rays.emplace_back();
      out.launch_angle_deg = declination(ray->launch_elevation);
      out.surface_bounces = ray->surface_bounces;
      out.bottom_bounces = ray->bottom_bounces;
      out.range.reserve(ray->points.size());
      out.depth.reserve(ray->points.size());
      for (const RayPoint& point : ray->points) {
        out.range.push_back(point.range);
        out.depth.push_back(point.depth);
      }
    }
  }
  return file;
}

}  // namespace asdic::detail::bellhop
