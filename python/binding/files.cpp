#include <map>

#include "watched.h"

namespace asdic::python {

void add_files(py::module_& module) {
  module.def("write_ping",
             [](const std::filesystem::path& path, const Scenario& scenario, const Ping& ping) {
               watched([&](const Watch&) {
                 write_ping(path, scenario, ping);
                 return true;
               });
             });
  module.def("write_scene", [](const std::filesystem::path& path, const Scenario& scenario) {
    watched([&](const Watch&) {
      write_scene(path, scenario);
      return true;
    });
  });
  module.def("write_area", [](const std::filesystem::path& path, const Scenario& scenario,
                              const std::vector<double>& depths, std::optional<double> reach,
                              int bearings, int ranges, std::optional<double> strength_db,
                              std::optional<std::string> fluctuation,
                              double false_alarm_probability, double reference_cells,
                              std::optional<std::string> transmitter,
                              std::optional<std::string> array, std::optional<int> ping,
                              const py::object& progress) {
    const AreaOptions options{.depths = depths,
                              .reach = reach,
                              .strength_db = strength_db,
                              .fluctuation = std::move(fluctuation),
                              .transmitter = std::move(transmitter),
                              .array = std::move(array),
                              .ping = ping,
                              .bearings = bearings,
                              .ranges = ranges,
                              .false_alarm_probability = false_alarm_probability,
                              .reference_cells = reference_cells};
    return watched([&](const Watch& watch) { return write_area(path, scenario, options, watch); },
                   progress);
  });
  module.def("write_pings", [](const std::filesystem::path& path, const Scenario& scenario,
                               const py::object& progress) {
    watched(
        [&](const Watch& watch) {
          write_pings(path, scenario, watch);
          return true;
        },
        progress);
  });
  module.def("read_ping", [](const std::filesystem::path& path, std::optional<int> number) {
    return watched([&](const Watch&) { return read_ping(path, number); });
  });
  module.def("pings_in", &pings_in);
  module.def("read_bellhop",
             [](const std::filesystem::path& root, const std::filesystem::path& maps) {
               BellhopCase found = read_bellhop(root, maps);
               return py::make_tuple(found.scenario, found.notes);
             });
  using Files = std::map<std::string, std::vector<std::string>>;
  module.def("ocean", [](double latitude, double longitude, std::optional<int> month,
                         const std::string& date, std::optional<double> bearing_deg,
                         std::optional<double> range, std::optional<double> step,
                         std::optional<double> area, const std::filesystem::path& output,
                         const Files& files, const std::filesystem::path& data) {
    OceanPlace place{.latitude_deg = latitude,
                     .longitude_deg = longitude,
                     .month = month,
                     .date = date,
                     .bearing_deg = bearing_deg,
                     .range = range,
                     .step = step,
                     .area = area,
                     .output = output,
                     .data = data};
    const auto of = [&](const char* quantity) {
      const auto found = files.find(quantity);
      return found == files.end() ? std::vector<std::string>{} : found->second;
    };
    place.temperature = of("temperature");
    place.salinity = of("salinity");
    place.sound_speed = of("sound_speed");
    place.bathymetry = of("bathymetry");
    place.wind = of("wind");
    place.sediment = of("sediment");
    const Ocean found = watched([&](const Watch&) { return ocean(place); });
    return py::make_tuple(found.scenario, found.origins, found.notes);
  });
  module.def("write_run", [](const std::filesystem::path& path, const Scenario& scenario,
                             const py::object& progress) {
    return watched([&](const Watch& watch) { return write_run(path, scenario, watch); }, progress);
  });
  module.def("convert_result",
             [](const std::filesystem::path& from, const std::filesystem::path& to) {
               watched([&](const Watch&) {
                 convert_result(from, to);
                 return true;
               });
             });
}

}  // namespace asdic::python
