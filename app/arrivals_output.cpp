#include "app/arrivals_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "app/console.h"
#include "core/units.h"
#include "io/ping/arrival_table.h"

namespace asdic::detail::app {
namespace {

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

/// s12.3 b20.1: in order, surface or bottom with the grazing angle.
std::string bounces_of(const Arrival& arrival) {
  std::string text;
  for (const Bounce& bounce : listed_bounces(arrival))
    text += fmt::format("{}{}{}", text.empty() ? "" : " ",
                        bounce.boundary == BoundaryKind::surface ? 's' : 'b',
                        number(degrees(bounce.grazing), 2));
  if (arrival.bounces.size() > most_listed_bounces)
    text += fmt::format(" and {} more", arrival.bounces.size() - most_listed_bounces);
  return text;
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
    std::vector<std::string> cells = {
        std::to_string(i),
        name_of(a.kind),
        number(degrees(a.launch_elevation), 3),
        number(degrees(a.arrival_elevation), 3),
        number(a.delay, 5),
        number(db_from_amplitude(std::abs(a.amplitude)), 2),
        number(degrees(std::arg(a.amplitude)), 1),
        number(-db_from_amplitude(a.spreading), 2),
        number(a.absorption_db, 2),
        number(-db_from_amplitude(std::abs(a.reflection)), 2),
        a.scattered > 0.0 ? number(db_from_power(a.scattered), 2) : "-",
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
