#include "library/propagation.h"

#include <cmath>

#include "asdic/field.h"
#include "asdic/ocean.h"
#include "asdic/rays.h"
#include "core/text.h"
#include "core/units.h"
#include "io/scenario/scenario_reader.h"
#include "library/arguments.h"
#include "library/watched.h"
#include "raytrace/cases/earth_line.h"
#include "raytrace/ocean/depth_in_water.h"
#include "raytrace/ocean/slice.h"
#include "raytrace/paths/trace_ray.h"

namespace asdic {
namespace {

/// An elevation in which rays get anywhere. \throws InputError
double launchable(const std::string& argument, double elevation) {
  if (std::abs(elevation) < 0.5 * detail::pi) return elevation;
  throw InputError(argument, detail::to_text(elevation) + " rad",
                   "an angle between -pi/2 and pi/2, both excluded");
}

/// Launch elevations of a fan [rad].
std::vector<double> elevations_of(const Fan& fan) {
  for (std::size_t i = 0; i < fan.elevations.size(); ++i)
    launchable("fan.elevations[" + std::to_string(i) + "]", fan.elevations[i]);
  if (!fan.elevations.empty()) return fan.elevations;
  const double low = launchable("fan.lowest", fan.lowest),
               high = launchable("fan.highest", fan.highest);
  require("fan.count", fan.count, 1, detail::most_traced_rays);
  std::vector<double> result;
  for (int i = 0; i < fan.count; ++i)
    result.push_back(fan.count == 1 ? low : std::lerp(low, high, double(i) / (fan.count - 1)));
  return result;
}

Ray shown(const detail::RayPath& ray, const detail::EarthLine& earth) {
  Ray result{.launch_elevation = ray.launch_elevation,
             .final_elevation = ray.final_elevation,
             .path_length = ray.path_length,
             .surface_bounces = ray.surface_bounces,
             .bottom_bounces = ray.bottom_bounces,
             .turns = ray.turns};
  for (const detail::RayPoint& point : ray.points) {
    result.range.push_back(point.range);
    result.depth.push_back(point.depth);
    result.time.push_back(point.time);
    if (!earth.known()) continue;
    const detail::GeographicPlace there = earth.at(point.range);
    result.latitude.push_back(there.latitude);
    result.longitude.push_back(there.longitude);
  }
  return result;
}

/// The ocean along the transect, a depth in it to start from, and where it is.
struct Plane {
  detail::Environment ocean;
  double source_depth;
  detail::EarthLine earth;
};
Plane plane_of(const Scenario& scenario) {
  const Scenario::Data& data = Access::data(scenario);
  std::vector<std::string> notes;
  if (!detail::has_sonar(data.document)) {
    const detail::PropagationCase run = run_case_of(scenario, notes);
    return {detail::plane_of(run), run.source_depths.front(), detail::EarthLine(run)};
  }
  const detail::Scenario sonar = detail::scenario_of(data.document, data.path);
  const detail::Vec3 platform = sonar.platforms[0].track.at(0.0).position;
  detail::PropagationCase along;
  along.origin = sonar.origin;
  if (sonar.area)
    along.on_area = {
        .area = sonar.area, .place = platform.head<2>(), .bearing = sonar.transect.bearing};
  if (sonar.area || detail::varies_with_range(sonar.environment))
    along.on_map = {.x = platform.x(), .y = platform.y(), .bearing = sonar.transect.bearing};
  return {detail::ocean_on_map(sonar).plane(platform.head<2>(), sonar.transect.bearing,
                                            detail::reach_of_area),
          platform.z(), detail::EarthLine(along)};
}

}  // namespace

detail::PropagationCase run_case_of(const Scenario& scenario, std::vector<std::string>& notes) {
  const Scenario::Data& data = Access::data(scenario);
  return detail::propagation_case_of(data.document, data.path, notes);
}

detail::PropagationResult run_of(const Scenario& scenario,
                                 const detail::PropagationCase& run_case) {
  const Scenario::Data& data = Access::data(scenario);
  try {
    return detail::run(run_case, {}, detail::budget_of(data.document));
  } catch (const detail::InputError& error) {
    throw detail::told_of_scenario(error, data.document, data.path);
  }
}

std::vector<double> sound_speed(const Scenario& scenario, const std::vector<double>& depths,
                                double range) {
  return translated([&] {
    require("range", range, {.noun = "range", .unit = "m", .low = -1e10, .high = 1e10});
    const Plane plane = plane_of(scenario);
    std::vector<double> found;
    for (const double depth : depths) {
      require("depths", depth, {.noun = "depth", .unit = "m", .low = -20e3, .high = 20e3});
      found.push_back(detail::sound_speed(plane.ocean, range, depth).c);
    }
    return found;
  });
}

std::vector<Ray> rays(const Scenario& scenario, const Fan& fan, const Watch& watch) {
  return watched(watch, [&] {
    const std::vector<double> elevations = elevations_of(fan);
    require("fan.range", fan.range, detail::traced_range);
    require("fan.bounces", fan.bounces, 0, detail::most_traced_bounces);
    const Plane plane = plane_of(scenario);
    const double depth = detail::depth_in_water(plane.ocean, "fan.source_depth",
                                                fan.source_depth.value_or(plane.source_depth));
    std::vector<Ray> result;
    for (const double elevation : elevations)
      result.push_back(
          shown(detail::trace_ray(plane.ocean, depth, elevation, fan.range, 50.0, fan.bounces),
                plane.earth));
    return result;
  });
}

EvenlySpaced::operator Value() const {
  return Value::table({{"first", first}, {"last", last}, {"count", count}});
}

double Field::loss_db(std::size_t row, std::size_t column, std::size_t source) const {
  const std::size_t rows = irregular ? 1 : depths.size();
  if (row >= rows || column >= ranges.size() || source >= source_depths.size())
    throw InputError("receiver",
                     "row " + std::to_string(row) + ", column " + std::to_string(column) +
                         ", source " + std::to_string(source),
                     "below " + std::to_string(rows) + ", " + std::to_string(ranges.size()) + ", " +
                         std::to_string(source_depths.size()));
  const std::size_t at = (source * rows + row) * ranges.size() + column;
  if (at >= pressure.size())
    throw InputError("pressure", detail::count_of(pressure.size(), "number"),
                     "one for each receiver of each source");
  const std::complex<double> p = pressure[at];
  return -detail::db_from_amplitude(std::abs(p));
}

Field field(const Scenario& scenario, const Watch& watch) {
  return watched(watch, [&] {
    Field result;
    detail::PropagationCase run = run_case_of(scenario, result.warnings);
    run.task = detail::Task::field;
    detail::PropagationResult found = run_of(scenario, run);
    result.frequency = run.frequency;
    result.source_depths = run.source_depths;
    result.depths = run.receivers.depths;
    result.ranges = run.receivers.ranges;
    result.irregular = run.receivers.irregular;
    result.pressure = std::move(found.field);
    result.beam_error_db = found.beam_error_db;
    result.warnings.insert(result.warnings.end(), found.notes.begin(), found.notes.end());
    const detail::EarthLine earth(run);
    for (const double range : earth.known() ? run.receivers.ranges : std::vector<double>{}) {
      const detail::GeographicPlace there = earth.at(range);
      result.latitudes.push_back(there.latitude);
      result.longitudes.push_back(there.longitude);
    }
    return result;
  });
}

}  // namespace asdic
