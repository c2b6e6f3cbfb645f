#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "app/command.h"
#include "app/console.h"
#include "app/progress_bar.h"
#include "app/sonar_text.h"
#include "core/units.h"
#include "io/scenario/area.h"
#include "io/scenario/document.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "io/text/material_text.h"
#include "raytrace/cases/memory.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/parallel/stop.h"
#include "sonar/ping/ping.h"
#include "sonar/ping/stream_parts.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::app {
namespace {

/// Lowest and highest speed in the water: of a section's samples, or looked at in 5000 depths.
std::pair<double, double> speeds(const Environment& ocean) {
  if (ocean.section) {
    const auto [low, high] =
        std::minmax_element(ocean.section->speeds().begin(), ocean.section->speeds().end());
    return {*low, *high};
  }
  const double top = ocean.surface.depth, bottom = ocean.bottom.depth;
  double low = ocean.water.at(top).c, high = low;
  constexpr int steps = 5000;
  for (int i = 0; i <= steps; ++i) {
    const double c = ocean.water.at(std::lerp(top, bottom, double(i) / steps)).c;
    low = std::min(low, c);
    high = std::max(high, c);
  }
  return {low, high};
}

/// The maps of an area, and the water under the platform.
std::string area_text(const Scenario& s) {
  const Area& area = *s.area;
  const Vec3 place = s.platforms[0].track.at(0.0).position;
  std::string text =
      fmt::format("area       {}, {}, {:.3g} m apart; the platform is over {:.0f} m\n",
                  area.floor().name(), word_of(area.floor().interpolation()),
                  area.spacing(place.head<2>()), area.bottom_depth(place.x(), place.y()));
  if (area.water())
    text += fmt::format("           {}, {}, {:.3g} km apart\n", area.water()->name(),
                        count_of(area.water()->depths().size(), "level"),
                        area.water()->spacing(place.x(), place.y()) / 1000.0);
  if (area.seabed())
    text += fmt::format("           {}, {}\n", area.seabed()->name(),
                        count_of(area.settings().classes.size(), "kind"));
  if (area.wind()) text += fmt::format("           {}\n", area.wind()->name());
  return text;
}

/// Where on the Earth the map is, and of what time its ocean.
std::string place_text(const std::optional<OceanOrigin>& origin) {
  if (!origin) return "";
  return fmt::format("place      {:g} N {:g} E is the map's [0, 0]{}\n", degrees(origin->latitude),
                     degrees(origin->longitude),
                     origin->time.empty() ? "" : "; its ocean: " + origin->time);
}

/// Where the transect lies along which the ocean varies.
std::string transect_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  if (s.area) return area_text(s);
  if (!varies_with_range(s.environment)) return "";
  return fmt::format(
      "transect   from {:g} m east, {:g} m north along {:g} deg true; the platform is at {:.3f} km "
      "of it, over {:.0f} m\n",
      s.transect.x, s.transect.y, compass_degrees(s.transect.bearing),
      simulator.paths().along(s.platforms[0].track.at(0.0).position) / 1000.0,
      simulator.paths().bottom_depth(s.platforms[0].track.at(0.0).position));
}

std::string depth_of_water(const Environment& ocean) {
  if (!ocean.bottom.shape) return fmt::format("{:g}", ocean.bottom.depth - ocean.surface.depth);
  return fmt::format("{:g} to {:g}", ocean.bottom.shape->shallowest() - ocean.surface.depth,
                     ocean.bottom.shape->deepest() - ocean.surface.depth);
}

std::string boundary_text(const Boundary& boundary) {
  std::string text = material_text(boundary.material);
  const Roughness& rough = boundary.roughness;
  if (rough.rms_height > 0.0) text += fmt::format(", rms height {:.3g} m", rough.rms_height);
  if (rough.sea_wind > 0.0) text += fmt::format(" (sea of {:g} m/s)", rough.sea_wind);
  if (rough.bubble_wind > 0.0) text += fmt::format(", bubbles of {:g} m/s", rough.bubble_wind);
  if (!boundary.shape) return text;
  const auto ranges = boundary.shape->ranges();
  text += fmt::format(", {}, {} from {:g} to {:g} km, {:g} to {:g} m deep",
                      name(boundary.shape->interpolation()), count_of(ranges.size(), "node"),
                      ranges.front() / 1000.0, ranges.back() / 1000.0, boundary.shape->shallowest(),
                      boundary.shape->deepest());
  if (!boundary.shape->materials().empty()) text += ", a material each";
  return text;
}

std::string environment_text(const Environment& ocean, double f, std::optional<double> wind) {
  const auto [low, high] = speeds(ocean);
  const double loss = db_per_neper * 1e3 * attenuation_np_per_m(ocean, f).at(ocean.surface.depth);
  std::string text = fmt::format(
      "water      {} m deep, sound speed {:.2f} to {:.2f} m/s, {:.4f} dB/km at {:g} Hz\n",
      depth_of_water(ocean), low, high, loss, f);
  if (ocean.section)
    text += fmt::format(
        "           {} from {:g} to {:g} km\n", count_of(ocean.section->ranges().size(), "profile"),
        ocean.section->ranges().front() / 1000.0, ocean.section->ranges().back() / 1000.0);
  text += "surface    " + boundary_text(ocean.surface);
  text += wind ? fmt::format(", wind {:g} m/s\n", *wind) : "\n";
  return text + "bottom     " + boundary_text(ocean.bottom) + "\n";
}

std::string size_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const PingSchedule& p = s.pings;
  const double rate = recorded_rate(s);
  const bool complex = p.samples == Samples::baseband;
  const double samples = p.continuous ? static_cast<double>(longest_stream_part(s))
                                      : std::round(p.recording_duration * rate);
  const double bytes = 4.0 * (complex ? 2.0 : 1.0) * samples * static_cast<double>(channels_of(s)) *
                           simulator.pings() +
                       8.0 * samples;  // the pressure and its time axis; tables are small beside it
  const std::string what =
      complex ? fmt::format("complex baseband about {:.6g} Hz, ", recorded_carrier(s)) : "";
  return fmt::format(
      "recording  {}, {:g} s apart, {}{}each {:g} s at {:g} Hz: {:.0f} samples a phone; "
      "a file of about {}\n",
      count_of(std::size_t(simulator.pings()), "ping"), p.interval,
      p.continuous ? "one stream, " : "", what, p.recording_duration, rate, samples,
      byte_count(bytes));
}

/// What a run asks for before it begins. \throws MemoryError if that is too much
std::string memory_text(const MemoryBudget& budget, const char* of) {
  std::string parts;
  for (const MemoryNeed& need : budget.needs())
    parts +=
        fmt::format("{}{} for {}", parts.empty() ? "" : ", ", byte_count(need.bytes), need.what);
  return fmt::format("memory     {} takes at most about {}: {}; it may take {}\n", of,
                     byte_count(budget.taken()), parts, budget.text());
}

std::string axis_text(const std::vector<double>& values, double unit) {
  if (values.size() == 1) return fmt::format("{:g}", values[0] / unit);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{} from {:g} to {:g}", values.size(), *low / unit, *high / unit);
}

std::string run_text(const PropagationCase& run) {
  std::string text =
      fmt::format("source     {}, {:g} Hz, at depths [m]: {}\n", word_of(run.beams.source),
                  run.frequency, axis_text(run.source_depths, 1.0));
  if (run.receivers.size() > 0)
    text +=
        fmt::format("receivers  {}at depths [m]: {}, ranges [km]: {}\n",
                    run.receivers.irregular ? "one by one, " : "",
                    axis_text(run.receivers.depths, 1.0), axis_text(run.receivers.ranges, 1000.0));
  text += fmt::format("fan        {:g} to {:g} deg\n", degrees(run.beams.lowest),
                      degrees(run.beams.highest));
  text += fmt::format("task       {}", word_of(run.task));
  if (run.task == Task::field)
    text += fmt::format(", {}, {} beams", word_of(run.field), word_of(run.beams.kind));
  return text + "\n";
}

/// Searches in three dimensions that take more than a moment, and about how long: seconds a place
/// where the floor is uneven and the water bends rays. \param receivers  0: unknown
std::string search_text(const Environment& ocean, bool uneven, std::size_t receivers, bool field) {
  const auto [low, high] = speeds(ocean);
  const bool hard = uneven && high - low > 1e-6 * low;
  if (receivers == 0)
    return hard ? "search     paths in three dimensions, where the floor is uneven and the water "
                  "bends rays: one to ten seconds of processor time for each new place\n"
                : "";
  const double n = static_cast<double>(receivers);
  const double each = hard ? (field ? 0.02 + 3.0 * std::min(1.0, 30.0 / n) : 3.0) : 0.05;
  const double seconds = n * each + (hard ? 2.0 : 0.0);
  if (seconds < 2.0) return "";
  const std::string time = seconds < 120.0 ? fmt::format("{:.0f} s", seconds)
                                           : fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format(
      "search     paths in three dimensions to {}: about {} of processor time, over a rough floor "
      "some times that. Sooner with fewer receivers, with a narrower run.fan or with "
      "run.dimension = 2\n",
      count_of(receivers, "receiver"), time);
}

/// Every setting that was read: key, value, unit, and whether the file leaves it to the default.
std::string all_text(const NotedSettings& noted) {
  std::string text;
  for (const NotedSetting& one : noted)
    text += fmt::format("{} = {}{}{}{}\n", one.key, one.value, one.unit.empty() ? "" : " ",
                        one.unit, one.given ? "" : " (default)");
  return text;
}

/// Processor time that each look at the paths of a ping may take [s].
constexpr double most_seconds = 3.0;

/// Does some work, and calls it off after `most_seconds`. \return whether the work was completed
bool done_in_time(const std::function<void()>& work) {
  std::stop_source too_long;
  std::mutex mutex;
  std::condition_variable_any ended;
  const std::clock_t begin = std::clock();
  const std::jthread watch([&](const std::stop_token& over) {
    std::unique_lock lock(mutex);
    const auto spent = [&] { return double(std::clock() - begin) > most_seconds * CLOCKS_PER_SEC; };
    while (!over.stop_requested() && !spent())
      ended.wait_for(lock, over, std::chrono::milliseconds(50), [] { return false; });
    if (!over.stop_requested()) too_long.request_stop();
  });
  try {
    until_stopped(too_long.get_token(), work);
    return true;
  } catch (const Interrupted&) {
    return false;
  }
}

struct ValidateOptions : ScenarioChoice {
  bool all = false;
};

/// An ocean and a run of the propagation model, without a sonar.
int validate_run(const ValidateOptions& choice, const TomlValue& document) {
  std::vector<std::string> notes;
  NotedSettings noted;
  const PropagationCase run = propagation_case_of(document, choice.path, notes, &noted);
  if (choice.all) {
    print(all_text(noted));
    return 0;
  }
  print(emphasised(run.title.empty() ? choice.path : run.title) + '\n');
  const std::size_t searched = run.source_depths.size() * run.receivers.size();
  print(environment_text(run.environment, run.frequency, std::nullopt) + run_text(run) +
        (run.dimension == 3 && searched > 0
             ? search_text(run.environment, run.on_area || run.environment.bottom.shape, searched,
                           run.task == Task::field)
             : "") +
        memory_text(run_memory(run, read_budget(choice.path, choice.overrides)), "the run"));
  for (const std::string& note : notes) print("warning: " + note + '\n');
  print(choice.path + ": good\n");
  return 0;
}

int validate_sonar(const ValidateOptions& choice, const TomlValue& document) {
  if (choice.all) {
    NotedSettings noted;
    static_cast<void>(scenario_of(document, choice.path, &noted));
    print(all_text(noted));
    return 0;
  }
  // Over rough ground, and where waves are summed, paths take long.
  std::optional<ProgressBar> bar(std::in_place, "reading the scenario", true);
  PingSimulator simulator(read_scenario(choice.path, choice.overrides), nullptr,
                          read_budget(choice.path, choice.overrides));
  bar->doing("paths of a ping, for its memory");
  std::optional<MemoryBudget> memory;  // known before anything allocates
  bool judged = done_in_time([&] { memory = simulator.memory(); });
  bar->doing("paths that a ping may lack");
  judged = judged && done_in_time([&] { simulator.judge_paths(); });
  bar.reset();
  const Scenario& scenario = simulator.scenario();
  print(emphasised(scenario.title.empty() ? scenario.path : scenario.title) + '\n');
  print(environment_text(scenario.environment, simulator.pulse().centre_frequency(),
                         scenario.wind_speed) +
        place_text(scenario.origin) + transect_text(simulator) + sonar_text(simulator) +
        (scenario.propagation.dimension == 3
             ? search_text(scenario.environment, scenario.area || scenario.environment.bottom.shape,
                           0, false)
             : "") +
        size_text(simulator) +
        (memory ? memory_text(*memory, "a ping") : "memory     of a ping: not known\n"));
  for (const std::string& note : scenario.notes) print("warning: " + note + '\n');
  if (!judged)
    print(fmt::format(
        "warning: the paths of a ping take more than {:g} s of processor time and were not looked "
        "at to the end: {}bounces or waves that a ping may lack are not known\n",
        most_seconds, memory ? "" : "its memory, and "));
  print(choice.path + ": good\n");
  return 0;
}

int validate(const ValidateOptions& choice) {
  const TomlValue document = scenario::read_document(read_text_file(choice.path, "a scenario file"),
                                                     choice.path, choice.overrides);
  try {
    return has_sonar(document) ? validate_sonar(choice, document) : validate_run(choice, document);
  } catch (const MemoryError& error) {
    throw told_of_scenario(error, choice.path, choice.overrides);
  }
}

}  // namespace

void add_validate_command(Program& program) {
  program.add_command(
      "validate", "Read and check a scenario or a run, and say what it means.",
      [](const Command& command) {
        auto choice = std::make_shared<ValidateOptions>();
        add_scenario_options(command, *choice);
        command.add_flag("--all", choice->all,
                         "instead: every setting as it was understood, given or default");
        command.footer(
            "Exit status: 0 good, 2 not.\n"
            "Example:  asdic validate scenarios/deep_ocean.toml --set pings.count=100");
        command.runs([choice] { return validate(*choice); });
      });
}

}  // namespace asdic::detail::app
