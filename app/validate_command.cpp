#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "io/scenario_reader.h"
#include "io/text/material_text.h"
#include "sonar/geometry.h"
#include "sonar/ping.h"

namespace asdic::app {
namespace {

std::string position(const Vec3& p) {
  return fmt::format("{:g} m east, {:g} m north, {:g} m deep", p.x(), p.y(), p.z());
}

std::string motion(const Vec3& v) {
  return v.isZero() ? "at rest" : fmt::format("moving at {:.2f} m/s", v.norm());
}

/// Lowest and highest speed in the water, sampled metre by metre.
std::pair<double, double> speeds(const Environment& ocean, double bottom) {
  if (ocean.section) {
    const auto all = ocean.section->speeds();
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    return {*low, *high};
  }
  double low = ocean.water.at(ocean.surface.depth).c, high = low;
  constexpr int steps = 5000;
  for (int i = 0; i <= steps; ++i) {
    const double c = ocean.water.at(std::lerp(ocean.surface.depth, bottom, double(i) / steps)).c;
    low = std::min(low, c);
    high = std::max(high, c);
  }
  return {low, high};
}

std::string extent(std::span<const double> ranges) {
  return fmt::format("from {:g} to {:g} km", ranges.front() / 1000.0, ranges.back() / 1000.0);
}

std::string boundary_text(const Boundary& boundary) {
  if (!boundary.shape) return material_text(boundary.material);
  const BoundaryShape& shape = *boundary.shape;
  return fmt::format("{:g} to {:g} m, {}, {} {}, {}", shape.shallowest(), shape.deepest(),
                     count_of(shape.ranges().size(), "node"), name(shape.interpolation()),
                     extent(shape.ranges()),
                     shape.materials().empty() ? material_text(boundary.material)
                                               : count_of(shape.materials().size(), "material"));
}

/// What varies along the transect, and where that lies.
std::string transect_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const Environment& ocean = s.environment;
  if (!ocean.section && !ocean.surface.shape && !ocean.bottom.shape) return "";
  std::string text = fmt::format(
      "transect   from {:g} m east, {:g} m north along {:g} deg; the platform is at {:.3f} km of "
      "it, over {:.0f} m\n",
      s.transect.x, s.transect.y, compass_degrees(s.transect.bearing),
      simulator.paths().along(s.platform.at(0.0).position) / 1000.0,
      simulator.paths().bottom_depth(s.platform.at(0.0).position));
  if (ocean.section)
    text += fmt::format(
        "section    {} {}, {}\n", count_of(ocean.section->ranges().size(), "profile"),
        extent(ocean.section->ranges()), count_of(ocean.section->depths().size(), "depth"));
  return text;
}

std::string environment_text(const PingSimulator& simulator) {
  const Environment& ocean = simulator.scenario().environment;
  const double surface =
                   ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth,
               bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const auto [low, high] = speeds(ocean, bottom);
  const double f = simulator.pulse().centre_frequency();
  std::string text = fmt::format(
      "water      {}{:g} m deep, sound speed {:.2f} to {:.2f} m/s, {:.4f} dB/km at {:g} Hz\n",
      ocean.bottom.shape ? "at most " : "", bottom - surface, low, high,
      absorption_db_per_km(ocean.absorption, f), f);
  text += transect_text(simulator);
  text += fmt::format("surface    {}, wind {:g} m/s\n", boundary_text(ocean.surface),
                      simulator.scenario().wind_speed);
  text += fmt::format("bottom     {}\n", boundary_text(ocean.bottom));
  return text;
}

std::string sonar_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const Kinematics platform = s.platform.at(0.0);
  const Pulse& pulse = simulator.pulse();
  constexpr const char* kinds[] = {"CW", "LFM", "HFM", "from a file"};
  constexpr const char* windows[] = {"no window", "Hann window", "Tukey window"};
  std::string text =
      fmt::format("platform   {}, {}\n", position(platform.position), motion(platform.velocity));
  text +=
      s.transmitter.taper == Taper::omnidirectional
          ? fmt::format("projector  {:g} dB, omnidirectional\n", s.transmitter.source_level_db)
          : fmt::format("projector  {:g} dB, elevation {:g} deg, beamwidth {:g} deg\n",
                        s.transmitter.source_level_db, degrees(simulator.transmitter(1).elevation),
                        degrees(s.transmitter.beamwidth));
  text +=
      fmt::format("pulse      {}, {:g} Hz, {:g} s, {}, band {:g} Hz\n",
                  kinds[static_cast<int>(s.pulse.kind)], pulse.centre_frequency(), pulse.duration(),
                  windows[static_cast<int>(s.pulse.window)], pulse.bandwidth_40db());
  double aperture = 0.0;
  for (const Vec3& a : s.array.phones)
    for (const Vec3& b : {s.array.phones.front(), s.array.phones.back()})
      aperture = std::max(aperture, (a - b).norm());
  text += fmt::format("array      {}, {:g} m across\n", count_of(s.array.phones.size(), "phone"),
                      aperture);
  for (const Target& target : s.targets) {
    const Kinematics k = target.track.at(0.0);
    const Separation way = separation(platform.position, k.position);
    text +=
        fmt::format("target     {}: {:g} dB, {}, range {:.3f} km, bearing {:.1f} deg, {}\n",
                    target.name, target.strength_db, position(k.position), way.range / 1000.0,
                    degrees(way.bearing) + (way.bearing < 0.0 ? 360.0 : 0.0), motion(k.velocity));
  }
  text += s.noise.spectral_level_db
              ? fmt::format("noise      {:g} dB re 1 µPa²/Hz\n", *s.noise.spectral_level_db)
              : "noise      none\n";
  text +=
      s.reverberation.enabled
          ? fmt::format("surface reverberation  {}, {} azimuths, ground grid of {:.3g} m\n",
                        std::visit([](const auto& m) { return m.name; }, s.reverberation.surface),
                        s.reverberation.azimuths, simulator.ground_spacing())
          : "surface reverberation  none\n";
  return text;
}

std::string size_text(const Scenario& s) {
  const PingSchedule& p = s.pings;
  const double samples = std::round(p.recording_duration * p.sample_rate);
  const double bytes = 4.0 * samples * static_cast<double>(s.array.phones.size()) * p.count +
                       8.0 * samples;  // the pressure and its time axis; tables are small beside it
  return fmt::format(
      "recording  {}, {:g} s apart, each {:g} s at {:g} Hz: {:.0f} samples a phone; "
      "a file of about {}\n",
      count_of(std::size_t(p.count), "ping"), p.interval, p.recording_duration, p.sample_rate,
      samples, byte_count(bytes));
}

int validate(const ScenarioChoice& choice) {
  const PingSimulator simulator(read_scenario(choice.path, choice.overrides));
  const Scenario& scenario = simulator.scenario();
  print(emphasised(scenario.title.empty() ? scenario.path : scenario.title) + '\n');
  print(environment_text(simulator) + sonar_text(simulator) + size_text(scenario));
  for (const std::string& note : scenario.notes) print("note: " + note + '\n');
  print(choice.path + ": good\n");
  return 0;
}

}  // namespace

void add_validate_command(CLI::App& program, Action& action) {
  auto choice = std::make_shared<ScenarioChoice>();
  CLI::App* command =
      program.add_subcommand("validate", "Read and check a scenario, and say what it means.");
  add_scenario_options(*command, *choice);
  command->footer(
      "Exit status: 0 good, 2 not.\n"
      "Example:  asdic validate scenarios/deep_ocean.toml --set pings.count=100");
  command->callback([choice, &action] { action = [choice] { return validate(*choice); }; });
}

}  // namespace asdic::app
