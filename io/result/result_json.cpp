#include "io/result/result_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "io/compare/statistics.h"
#include "io/scenario/propagation.h"
#include "raytrace/cases/beam_error_text.h"

namespace asdic::detail {

using nlohmann::ordered_json;

// Arrivals ------------------------------------------------------------------------------------

std::span<const Bounce> listed_bounces(const Arrival& arrival) {
  return std::span(arrival.bounces).first(std::min(arrival.bounces.size(), most_listed_bounces));
}

const char* name_of(ArrivalKind kind) {
  switch (kind) {
    case ArrivalKind::ray:
      return "ray";
    case ArrivalKind::diffracted:
      return "diffracted";
    case ArrivalKind::caustic:
      return "caustic";
  }
  return "";
}

namespace {

std::string leg_name(const Leg& leg) {
  return leg.kind == Leg::Kind::source_to_target ? "target" : "array";
}

/// Level of what rough boundaries scatter about the path.
double scattered_db(const Arrival& a) { return db_from_power(a.scattered); }

ordered_json json_of(const Arrivals& arrivals) {
  ordered_json paths = ordered_json::array();
  for (const Arrival& a : arrivals) {
    ordered_json bounces = ordered_json::array();
    for (const Bounce& bounce : listed_bounces(a))
      bounces.push_back(
          {{"boundary", bounce.boundary == BoundaryKind::surface ? "surface" : "bottom"},
           {"grazing_deg", degrees(bounce.grazing)},
           {"range", bounce.range}});
    paths.push_back({{"kind", name_of(a.kind)},
                     {"launch_elevation_deg", degrees(a.launch_elevation)},
                     {"arrival_elevation_deg", degrees(a.arrival_elevation)},
                     {"launch_deflection_deg", degrees(a.launch_deflection)},
                     {"arrival_deflection_deg", degrees(a.arrival_deflection)},
                     {"delay", a.delay},
                     {"level_db", db_from_amplitude(std::abs(a.amplitude))},
                     {"phase_deg", degrees(std::arg(a.amplitude))},
                     {"amplitude_real", a.amplitude.real()},
                     {"amplitude_imag", a.amplitude.imag()},
                     {"spreading_db", -db_from_amplitude(a.spreading)},
                     {"absorption_db", a.absorption_db},
                     {"reflection_db", 0.0 - db_from_amplitude(std::abs(a.reflection))},
                     {"scattered_db", scattered_db(a)},
                     {"path_length", a.path_length},
                     {"upper_turns", a.upper_turns},
                     {"lower_turns", a.lower_turns},
                     {"caustics", a.caustics},
                     {"bounces", bounces}});
    if (a.bounces.size() > most_listed_bounces)
      paths.back()["more_bounces"] = a.bounces.size() - most_listed_bounces;
  }
  return paths;
}

}  // namespace

std::string paths_json(const Arrivals& arrivals) { return json_of(arrivals).dump(); }

std::string arrivals_json(const ArrivalsResult& result) {
  ordered_json legs = ordered_json::array();
  for (const Leg& leg : result.legs) {
    ordered_json one;
    if (!result.to_receiver) {
      one["leg"] = leg_name(leg);
      one["target"] = leg.target;
      one["target_name"] = result.targets[static_cast<std::size_t>(leg.target)];
      one["bearing_deg"] = compass_degrees(leg.bearing);
    } else {
      one["leg"] = "receiver";
    }
    one["range"] = leg.range;
    if (const GeographicPlace end = result.earth.at(leg.end.x(), leg.end.y());
        !std::isnan(end.latitude)) {
      one["latitude"] = end.latitude;
      one["longitude"] = end.longitude;
    }
    one["arrivals"] = json_of(leg.arrivals);
    legs.push_back(one);
  }
  const ordered_json all = {{"filetype", "asdic arrivals"},
                            {"version", "1.0"},
                            {"title", result.origin.title},
                            {"scenario", result.origin.path},
                            {"ping", result.ping},
                            {"frequency_hz", result.frequency},
                            {"legs", legs}};
  return all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

// Rays ----------------------------------------------------------------------------------------

std::string rays_json(const RaysResult& result) {
  const EarthLine earth(result.run_case);
  ordered_json list = ordered_json::array();
  for (const RayPath& ray : result.rays()) {
    ordered_json range = ordered_json::array(), depth = range, time = range, latitude = range,
                 longitude = range;
    for (const RayPoint& point : ray.points) {
      const GeographicPlace there = earth.at(point.range);
      latitude.push_back(there.latitude);
      longitude.push_back(there.longitude);
      range.push_back(point.range);
      depth.push_back(point.depth);
      time.push_back(point.time);
    }
    list.push_back({{"launch_elevation_deg", degrees(ray.launch_elevation)},
                    {"final_elevation_deg", degrees(ray.final_elevation)},
                    {"travel_time", ray.points.back().time},
                    {"path_length", ray.path_length},
                    {"surface_bounces", ray.surface_bounces},
                    {"bottom_bounces", ray.bottom_bounces},
                    {"turns", ray.turns},
                    {"surface_hits", ray.surface_hits},
                    {"range", range},
                    {"depth", depth},
                    {"time", time}});
    if (!earth.known()) continue;
    list.back()["latitude"] = latitude;
    list.back()["longitude"] = longitude;
  }
  const ordered_json all = {{"filetype", "asdic rays"},
                            {"version", "1.0"},
                            {"title", result.origin.title},
                            {"scenario", result.origin.path},
                            {"source_depth", result.source_depth()},
                            {"rays", list}};
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

// Fields --------------------------------------------------------------------------------------

std::vector<double> losses_of(const std::vector<std::complex<float>>& pressure) {
  std::vector<double> all;
  for (const std::complex<float> p : pressure)
    if (const double magnitude = std::abs(std::complex<double>(p)); magnitude > 0.0)
      all.push_back(-20.0 * std::log10(magnitude));
  std::sort(all.begin(), all.end());
  return all;
}

double silent_pct(std::size_t receivers, std::size_t received) {
  const auto all = static_cast<double>(receivers);
  return all > 0.0 ? 100.0 * (all - static_cast<double>(received)) / all : 0.0;
}

FieldData field_data(const PropagationCase& run_case, PropagationResult&& result) {
  return {.title = run_case.title,
          .frequency = run_case.frequency,
          .kind = run_case.field,
          .source = run_case.beams.source,
          .source_depths = run_case.source_depths,
          .receivers = run_case.receivers,
          .pressure = std::move(result.field),
          .beam_kind = std::string(word_of(run_case.beams.kind)),
          .beams = result.beams,
          .beam_error_db = result.beam_error_db,
          .beam_error_bounded = result.beam_error_bounded,
          .beam_errors = std::move(result.beam_errors),
          .solver = std::string(word_of(result.waves ? FieldSolver::waves : FieldSolver::beams)),
          .earth = EarthLine(run_case)};
}

std::string field_json(const FieldResult& result) {
  const FieldData& data = result.data;
  const std::vector<double> tl = losses_of(data.pressure);
  const double sure = share_sure(data.beam_errors);
  ordered_json loss;
  if (!tl.empty())
    loss = {{"least", tl.front()}, {"median", compare::quantile(tl, 0.5)}, {"greatest", tl.back()}};
  const ordered_json all = {{"filetype", "asdic field summary"},
                            {"version", "1.0"},
                            {"title", data.title},
                            {"scenario", result.origin.path},
                            {"output", result.output.string()},
                            {"frequency_hz", data.frequency},
                            {"field", word_of(data.kind)},
                            {"source", word_of(data.source)},
                            {"source_depths", data.source_depths.size()},
                            {"receivers", data.receivers.size()},
                            {"beam_kind", data.beam_kind},
                            {"solver", data.solver},
                            {"beams", data.beams},
                            {"beam_error_db", data.beam_error_db},
                            {"beam_error_bounded", data.beam_error_bounded},
                            {"sure_pct", 100.0 * sure},
                            {"sure_db", sure_db},
                            {"tl_db", loss},
                            {"silent_pct", silent_pct(data.pressure.size(), tl.size())},
                            {"warnings", result.origin.warnings},
                            {"notes", result.notes}};
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace asdic::detail
