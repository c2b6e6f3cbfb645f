#include <cmath>

#include "watched.h"

namespace asdic::python {
namespace {

using namespace py::literals;

Receiving receiving_of(const py::dict& options) {
  Receiving made;
  const auto take = [&](const char* name, auto& to) {
    if (options.contains(name)) to = options[name].cast<std::decay_t<decltype(to)>>();
  };
  take("mvdr", made.mvdr);
  take("hann_shading", made.hann_shading);
  take("max_speed", made.max_speed);
  take("split_window", made.split_window);
  take("across_beams", made.across_beams);
  take("guard_cells", made.guard_cells);
  take("reference_cells", made.reference_cells);
  take("false_alarm_probability", made.false_alarm_probability);
  if (options.contains("sub_bands")) {
    const auto parts = options["sub_bands"].cast<double>();
    if (!(parts >= 1.0 && parts <= 256.0 && parts == std::floor(parts)))
      throw InputError("sub_bands", std::to_string(parts), "a whole number from 1 to 256");
    made.sub_bands = static_cast<int>(parts);
  }
  take("cancel_direct_blast", made.cancel_direct_blast);
  take("start", made.from);
  take("stop", made.until);
  take("target_depth", made.target_depth);
  take("range_speed", made.range_speed);
  return made;
}

py::dict shown(const Processed& all) {
  const auto& found = all.detections;
  const auto whole = [&](auto get) { return column<std::int32_t>(found, get); };
  const auto number = [&](auto get) { return column<double>(found, get); };
  py::list places, tracks;
  for (const Detection& d : found) {
    py::list of_it;
    for (const Place& p : d.places)
      of_it.append(py::dict("position"_a = p.position, "range"_a = p.range,
                            "bearing_deg"_a = bearing_deg(p.bearing), "range_rate"_a = p.range_rate,
                            "latitude"_a = p.latitude_deg, "longitude"_a = p.longitude_deg));
    places.append(of_it);
  }
  for (const Track& track : all.tracks) {
    py::list points;
    for (const TrackPoint& p : track.points)
      points.append(py::dict("ping"_a = p.ping, "detection"_a = p.detection, "time"_a = p.time,
                             "east"_a = p.position[0], "north"_a = p.position[1],
                             "velocity_east"_a = p.velocity[0], "velocity_north"_a = p.velocity[1],
                             "position_sigma"_a = p.position_sigma, "latitude"_a = p.latitude_deg,
                             "longitude"_a = p.longitude_deg));
    tracks.append(py::dict("array"_a = track.array, "ambiguous"_a = track.ambiguous,
                           "target"_a = track.target, "points"_a = points));
  }
  return py::dict("detections"_a = py::dict(
                      "ping"_a = whole([](const Detection& d) { return d.ping; }),
                      "array"_a = whole([](const Detection& d) { return d.array; }),
                      "time"_a = number([](const Detection& d) { return d.time; }),
                      "doppler_factor"_a = number([](const Detection& d) { return d.doppler; }),
                      "look_bearing_deg"_a =
                          number([](const Detection& d) { return bearing_deg(d.look_bearing); }),
                      "look_elevation_deg"_a =
                          number([](const Detection& d) { return degrees(d.look_elevation); }),
                      "snr_db"_a = number([](const Detection& d) { return d.snr_db; }),
                      "excess_db"_a = number([](const Detection& d) { return d.excess_db; }),
                      "level_db"_a = number([](const Detection& d) { return d.level_db; }),
                      "target"_a = whole([](const Detection& d) { return d.target; })),
                  "places"_a = places, "tracks"_a = tracks, "warnings"_a = all.warnings,
                  "notes"_a = all.notes, "on_earth"_a = all.on_earth);
}

}  // namespace

void add_process(py::module_& module) {
  module.def("process_file", [](const std::filesystem::path& file, const py::dict& options,
                                const py::object& progress) {
    const Receiving how = receiving_of(options);
    return shown(watched([&](const Watch& watch) { return process(file, how, watch); }, progress));
  });
  module.def("process_pings", [](const std::vector<Ping>& pings, const py::dict& options,
                                 const py::object& progress) {
    const Receiving how = receiving_of(options);
    return shown(watched([&](const Watch& watch) { return process(pings, how, watch); }, progress));
  });
}

}  // namespace asdic::python
