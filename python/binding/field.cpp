#include "watched.h"

namespace asdic::python {
namespace {

using namespace py::literals;

py::dict field_of(const Scenario& scenario) {
  Field found = watched([&](const Watch& watch) { return field(scenario, watch); });
  const auto size = [](const auto& values) { return static_cast<py::ssize_t>(values.size()); };
  std::vector<py::ssize_t> shape = {size(found.source_depths)};
  if (!found.irregular) shape.push_back(size(found.depths));
  shape.push_back(size(found.ranges));
  py::dict made(
      "frequency"_a = found.frequency, "source_depth"_a = taken(std::move(found.source_depths)),
      "depth"_a = taken(std::move(found.depths)), "range"_a = taken(std::move(found.ranges)),
      "irregular"_a = found.irregular, "pressure"_a = taken(std::move(found.pressure), shape),
      "beam_error_db"_a = found.beam_error_db, "warnings"_a = found.warnings);
  if (!found.latitudes.empty()) {
    made["latitude"] = taken(std::move(found.latitudes));
    made["longitude"] = taken(std::move(found.longitudes));
  }
  return made;
}

py::list rays_of(const Scenario& scenario, double lowest_deg, double highest_deg, int count,
                 const std::vector<double>& elevations_deg, double range,
                 std::optional<double> source_depth, int bounces) {
  Fan fan{.lowest = radians(lowest_deg),
          .highest = radians(highest_deg),
          .count = count,
          .elevations = {},
          .range = range,
          .source_depth = source_depth,
          .bounces = bounces};
  for (const double elevation : elevations_deg) fan.elevations.push_back(radians(elevation));
  std::vector<Ray> found = watched([&](const Watch& watch) { return rays(scenario, fan, watch); });
  py::list made;
  for (Ray& ray : found) {
    const bool known = !ray.latitude.empty();
    py::dict one("launch_elevation_deg"_a = degrees(ray.launch_elevation),
                 "final_elevation_deg"_a = degrees(ray.final_elevation),
                 "path_length"_a = ray.path_length, "surface_bounces"_a = ray.surface_bounces,
                 "bottom_bounces"_a = ray.bottom_bounces, "turns"_a = ray.turns,
                 "range"_a = taken(std::move(ray.range)), "depth"_a = taken(std::move(ray.depth)),
                 "time"_a = taken(std::move(ray.time)));
    if (known) {
      one["latitude"] = taken(std::move(ray.latitude));
      one["longitude"] = taken(std::move(ray.longitude));
    }
    made.append(std::move(one));
  }
  return made;
}

}  // namespace

void add_field(py::module_& module) {
  module.def("field", &field_of);
  module.def("rays", &rays_of);
  module.def("sound_speed",
             [](const Scenario& scenario, const std::vector<double>& depths, double range) {
               return taken(sound_speed(scenario, depths, range));
             });
  module.def(
      "waveform", [](const Scenario& scenario, int transmitter, std::optional<double> sample_rate) {
        Waveform found = waveform(scenario, transmitter, sample_rate);
        return py::dict("sample_rate"_a = found.sample_rate,
                        "analytic"_a = taken(std::move(found.analytic)),
                        "source_level_db"_a = found.source_level_db,
                        "centre_frequency"_a = found.centre_frequency, "energy"_a = found.energy);
      });
}

}  // namespace asdic::python
