#include "serve/commands/rays.h"

#include <cmath>

#include "core/text.h"
#include "core/units.h"
#include "io/result/result_json.h"
#include "raytrace/cases/earth_line.h"
#include "raytrace/ocean/depth_in_water.h"
#include "raytrace/ocean/slice.h"
#include "raytrace/parallel/stop.h"
#include "serve/answers.h"
#include "serve/refusal.h"
#include "serve/sound_request.h"

namespace asdic::detail::serve {
namespace {

constexpr std::size_t point_bytes = 240;  // of memory, while JSON is made of it

/// Where the plane of the rays is, as EarthLine wants it.
PropagationCase place_of(const Scenario& scenario, const Vec3& platform, double bearing) {
  PropagationCase along;
  along.origin = scenario.origin;
  if (scenario.area)
    along.on_area = {.area = scenario.area, .place = platform.head<2>(), .bearing = bearing};
  if (scenario.area || varies_with_range(scenario.environment))
    along.on_map = {.x = platform.x(), .y = platform.y(), .bearing = bearing};
  return along;
}

void check(const RaysRequest& asked, const SessionLimits& limits) {
  const auto ends = {std::abs(asked.from_deg), std::abs(asked.to_deg)};
  double steepest = std::max(ends);
  for (const double elevation : asked.elevations_deg)
    steepest = std::max(steepest, std::abs(elevation));
  if (!(steepest < 90.0))
    throw Refusal("value",
                  refusal_text(asked.elevations_deg.empty() ? "from_deg, to_deg" : "elevations_deg",
                               to_text(steepest) + " degrees",
                               "an angle between -90 and 90 degrees, both excluded"));
  const std::size_t rays =
      asked.elevations_deg.empty() ? std::size_t(asked.count) : asked.elevations_deg.size();
  if (rays > limits.rays)
    throw Refusal("limit", refusal_text("rays", std::to_string(rays),
                                        "at most " + std::to_string(limits.rays)));
}

}  // namespace

Answer RaysCommand::run(SessionState& session, const Command& command) {
  const auto asked = read_request<RaysRequest>(command.fields);
  const SessionLimits& limits = session.settings.limits;
  check(asked, limits);
  const Scenario& scenario = session.live.state().scenario;
  const double time = asked.time.value_or(session.now());
  const Vec3 platform = scenario.platforms[0].track.at(time).position;
  const double bearing =
      asked.bearing_deg ? radians(*asked.bearing_deg) : scenario.transect.bearing;
  RaysResult result{.origin = origin_of(scenario),
                    .run_case = place_of(scenario, platform, bearing)};
  const Environment plane =
      ocean_on_map(scenario).plane(platform.head<2>(), bearing, reach_of_area);
  const double depth = asked.source_depth.value_or(platform.z());
  try {
    depth_in_water(plane, "source_depth", depth);
  } catch (const InputError& error) {
    throw Refusal(
        "scenario",
        refusal_text("source_depth", asked.source_depth ? error.fault().got : "the platform's",
                     error.fault().expected));
  }
  result.run_case.source_depths = {depth};
  std::vector<RayPath>& rays = result.rays_of_source.emplace_back();
  std::size_t points = 0;
  for (const double elevation : asked.elevations()) {
    stop_point();
    rays.push_back(trace_ray(plane, depth, elevation, asked.range, 50.0, asked.bounces));
    points += rays.back().points.size();
    if (points > limits.answer_bytes / point_bytes)
      throw Refusal("limit", refusal_text("rays", "more points",
                                          "at most " + std::to_string(limits.answer_bytes) +
                                              " bytes in an answer"));
  }
  stop_point();
  return {.line = result_line(command.id, time, rays_json(result), scenario.notes)};
}

}  // namespace asdic::detail::serve
