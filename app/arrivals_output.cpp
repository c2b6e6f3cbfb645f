#include "app/arrivals_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "app/console.h"
#include "core/units.h"
#include "io/ping/arrival_table.h"

namespace asdic::detail::app {
namespace {

using nlohmann::ordered_json;

std::string leg_name(const Leg& leg) {
  return leg.kind == Leg::Kind::source_to_target ? "target" : "array";
}

std::string title_of(const ArrivalsResult& result, const Leg& leg) {
  const std::string distance = fmt::format("{} km", number(leg.range / 1000.0, 3));
  const std::string found = count_of(leg.arrivals.size(), "path");
  if (result.to_receiver) return fmt::format("to a receiver at {}: {}", distance, found);
  const std::string& target = result.targets[static_cast<std::size_t>(leg.target)];
  return fmt::format("{}, {}, bearing {} deg true: {}",
                     leg.kind == Leg::Kind::source_to_target ? fmt::format("platform to {}", target)
                                                             : fmt::format("{} to array", target),
                     distance, number(compass_degrees(leg.bearing), 1), found);
}

/// Bounces of a path that are listed one by one. A guide without loss has paths of thousands.
constexpr std::size_t most_listed = 256;

std::span<const Bounce> listed_bounces(const Arrival& arrival) {
  return std::span(arrival.bounces).first(std::min(arrival.bounces.size(), most_listed));
}

/// s12.3 b20.1: in order, surface or bottom with the grazing angle.
std::string bounces_of(const Arrival& arrival) {
  std::string text;
  for (const Bounce& bounce : listed_bounces(arrival))
    text += fmt::format("{}{}{}", text.empty() ? "" : " ",
                        bounce.boundary == BoundaryKind::surface ? 's' : 'b',
                        number(degrees(bounce.grazing), 2));
  if (arrival.bounces.size() > most_listed)
    text += fmt::format(" and {} more", arrival.bounces.size() - most_listed);
  return text;
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
    if (a.bounces.size() > most_listed)
      paths.back()["more_bounces"] = a.bounces.size() - most_listed;
  }
  return paths;
}

}  // namespace

std::string paths_table(const Arrivals& arrivals) {
  if (arrivals.empty()) return {};
  const bool turned = std::any_of(arrivals.begin(), arrivals.end(), [](const Arrival& a) {
    return a.launch_deflection != 0.0 || a.arrival_deflection != 0.0;
  });
  std::vector<Table::Column> columns = {{"path"},
                                        {"kind"},
                                        {"launch", "deg"},
                                        {"arrival", "deg"},
                                        {"delay", "s"},
                                        {"level", "dB"},
                                        {"phase", "deg"},
                                        {"spreading", "dB"},
                                        {"absorption", "dB"},
                                        {"reflection", "dB"},
                                        {"scattered", "dB"},
                                        {"turns"},
                                        {"caustics"},
                                        {"bounces", "deg", true}};
  constexpr std::ptrdiff_t after_angles = 4;
  if (turned)  // in three dimensions
    columns.insert(columns.begin() + after_angles,
                   {{"leaves aside", "deg"}, {"comes aside", "deg"}});
  Table table(std::move(columns));
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const Arrival& a = arrivals[i];
    std::vector<std::string> cells = {std::to_string(i),
                                      name_of(a.kind),
                                      number(degrees(a.launch_elevation), 3),
                                      number(degrees(a.arrival_elevation), 3),
                                      number(a.delay, 5),
                                      number(db_from_amplitude(std::abs(a.amplitude)), 2),
                                      number(degrees(std::arg(a.amplitude)), 1),
                                      number(-db_from_amplitude(a.spreading), 2),
                                      number(a.absorption_db, 2),
                                      number(-db_from_amplitude(std::abs(a.reflection)), 2),
                                      a.scattered > 0.0 ? number(scattered_db(a), 2) : "-",
                                      std::to_string(a.upper_turns + a.lower_turns),
                                      std::to_string(a.caustics),
                                      bounces_of(a)};
    if (turned)
      cells.insert(cells.begin() + after_angles, {number(degrees(a.launch_deflection), 3),
                                                  number(degrees(a.arrival_deflection), 3)});
    table.row(std::move(cells));
  }
  return table.text() +
         (turned ? "aside: of travel, clockwise from the straight line between the ends\n" : "");
}

std::string arrivals_legend(double frequency) {
  return fmt::format(
      "\nlosses at {} Hz; level re the pressure at 1 m; elevations of travel, "
      "positive up; scattered: beside the level, of what rough boundaries scatter about the path; "
      "bounces: s surface, b bottom, with grazing angle\n",
      frequency);
}

std::string arrivals_table(const ArrivalsResult& result) {
  std::string text;
  for (const Leg& leg : result.legs) {
    if (!text.empty()) text += '\n';
    text += emphasised(title_of(result, leg)) + '\n' + paths_table(leg.arrivals);
  }
  return text + arrivals_legend(result.frequency);
}

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

void write_arrivals_file(OutputFile&& to, const ArrivalsResult& result) {
  Hdf5Output output(std::move(to));
  Hdf5File& file = output.file();
  write_root(file, "asdic arrivals", result.origin);
  file.set_attribute("", "frequency_hz", result.frequency);
  if (result.to_receiver) {
    file.set_attribute("", "source_depth_m", result.source_depth);
    file.set_attribute("", "receiver_depth_m", result.receiver_depth);
  }

  ArrivalTable arrivals(file, result.earth);
  for (Leg leg : result.legs) {
    if (result.to_receiver) {
      leg.kind = Leg::Kind::source_to_receiver;
      leg.bearing = std::nan("");
    }
    arrivals.add(result.ping, leg);
  }
  arrivals.write();
  output.finish();
}

}  // namespace asdic::detail::app
