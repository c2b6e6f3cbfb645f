#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "io/scenario/propagation.h"
#include "io/scenario_reader.h"
#include "io/text/material_text.h"
#include "sonar/geometry.h"
#include "sonar/noise_spectrum.h"
#include "sonar/ping.h"
#include "sonar/sampling.h"
#include "sonar/stream.h"

namespace asdic::app {
namespace {

const double db_per_neper = 20.0 / std::log(10.0);

std::string position(const Vec3& p) {
  return fmt::format("{:g} m east, {:g} m north, {:g} m deep", p.x(), p.y(), p.z());
}

std::string motion(const Vec3& v) {
  return v.isZero() ? "at rest" : fmt::format("moving at {:.2f} m/s", v.norm());
}

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

/// Where the transect lies along which the ocean varies.
std::string reverberation_text(const Scenario& s, double spacing) {
  const ReverberationSettings& r = s.reverberation;
  std::string text =
      r.enabled && r.surface_scatters
          ? fmt::format("surface reverberation  {}, {}{} azimuths, ground grid of {:.3g} m\n",
                        name_of(r.surface), r.resolve_azimuth ? "at least " : "", r.azimuths,
                        spacing)
          : "surface reverberation  none\n";
  if (!r.enabled) return text;
  if (r.bottom) text += fmt::format("bottom reverberation   {}\n", name_of(*r.bottom));
  for (const VolumeLayer& layer : r.volume)
    text += fmt::format("volume reverberation   {:g} dB re 1/m from {:g} to {:g} m\n",
                        layer.strength_db, layer.top, layer.bottom);
  return text;
}

std::string transect_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const Environment& ocean = s.environment;
  if (!ocean.section && !ocean.surface.shape && !ocean.bottom.shape) return "";
  return fmt::format(
      "transect   from {:g} m east, {:g} m north along {:g} deg; the platform is at {:.3f} km of "
      "it, over {:.0f} m\n",
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
  if (!boundary.roughness.smooth())
    text += fmt::format(", rms height {:.3g} m", boundary.roughness.rms_height);
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

/// "transmitter" or, where there are several, "transmitter NAME on PLATFORM".
template <class Carried>
std::string carried(const Scenario& s, std::string_view what, const Carried& one,
                    std::size_t count) {
  if (count == 1 && s.platforms.size() == 1) return fmt::format("{:<10} ", what);
  return fmt::format("{:<10} {} on {}: ", what, one.name,
                     s.platforms[static_cast<std::size_t>(one.platform)].name);
}

std::string pulse_text(const Scenario& s, int transmitter) {
  constexpr const char* kinds[] = {"CW", "LFM", "HFM", "from a file"};
  constexpr const char* windows[] = {"no window", "Hann window", "Tukey window"};
  const PulseSettings& settings = pulse_of(s, transmitter);
  const Pulse pulse(settings);
  return fmt::format("pulse      {}, {:g} Hz, {:g} s, {}, band {:g} Hz\n",
                     kinds[static_cast<int>(settings.kind)], pulse.centre_frequency(),
                     pulse.duration(), windows[static_cast<int>(settings.window)],
                     pulse.bandwidth_40db());
}

std::string transmitter_text(const PingSimulator& simulator, std::size_t t) {
  const Scenario& s = simulator.scenario();
  const Transmitter& one = s.transmitters[t];
  const std::string who = carried(s, "projector", one, s.transmitters.size());
  if (one.taper == Taper::omnidirectional)
    return who + fmt::format("{:g} dB, omnidirectional\n", one.source_level_db);
  double elevation = one.elevation;
  for (int ping = 1; ping <= simulator.pings(); ++ping) {
    if (simulator.transmission(ping).transmitter != static_cast<int>(t)) continue;
    elevation = simulator.transmission(ping).elevation;  // of its first ping
    break;
  }
  return who + fmt::format("{:g} dB, elevation {:g} deg, beamwidth {:g} deg\n", one.source_level_db,
                           degrees(elevation), degrees(one.beamwidth));
}

std::string array_text(const Scenario& s, const ReceiverArray& array) {
  double aperture = 0.0;
  for (const Vec3& a : array.phones)
    for (const Vec3& b : {array.phones.front(), array.phones.back()})
      aperture = std::max(aperture, (a - b).norm());
  return carried(s, "array", array, s.arrays.size()) +
         fmt::format("{}, {:g} m across\n", count_of(array.phones.size(), "phone"), aperture);
}

/// Which spectrum, and what it comes to at the pulse; between the phones.
std::string noise_text(const PingSimulator& simulator) {
  const NoiseSettings& noise = simulator.scenario().noise;
  if (!noise.any()) return "noise      none\n";
  const double f = simulator.pulse().centre_frequency();
  std::string text = "noise      ";
  if (!noise.law) text += fmt::format("{:g} dB re 1 µPa²/Hz", *noise.spectral_level_db);
  if (noise.law) {
    if (const auto* wenz = std::get_if<WenzNoise>(&*noise.law))
      text += fmt::format("Wenz, shipping {:g}, wind {:g} m/s", wenz->shipping, wenz->wind_speed);
    else if (const auto* knudsen = std::get_if<KnudsenNoise>(&*noise.law))
      text += fmt::format("Knudsen, sea state {:.2g}", knudsen->sea_state);
    else
      text += "by a table";
  }
  if (noise.thermal) text += ", thermal";
  if (noise.law || noise.thermal)
    text += fmt::format(": {:.1f} dB re 1 µPa²/Hz at {:g} Hz", noise_level_db(noise, f), f);
  constexpr const char* between[] = {"", ", isotropic", ", from a sheet under the surface",
                                     ", by a profile over elevation"};
  return text + between[static_cast<int>(noise.coherence)] + "\n";
}

std::string sonar_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const Kinematics platform = s.platforms[0].track.at(0.0);
  std::string text;
  for (const Platform& one : s.platforms) {
    const Kinematics k = one.track.at(0.0);
    text += fmt::format("platform   {}{}, {}\n", s.platforms.size() > 1 ? one.name + ": " : "",
                        position(k.position), motion(k.velocity));
  }
  for (std::size_t t = 0; t < s.transmitters.size(); ++t) {
    text += transmitter_text(simulator, t);
    if (t == 0 || s.transmitters[t].pulse) text += pulse_text(s, static_cast<int>(t));
  }
  for (const ReceiverArray& array : s.arrays) text += array_text(s, array);
  for (const Target& target : s.targets) {
    const Kinematics k = target.track.at(0.0);
    const Separation way = separation(platform.position, k.position);
    text +=
        fmt::format("target     {}: {:g} dB, {}, range {:.3f} km, bearing {:.1f} deg, {}\n",
                    target.name, target.strength_db, position(k.position), way.range / 1000.0,
                    degrees(way.bearing) + (way.bearing < 0.0 ? 360.0 : 0.0), motion(k.velocity));
  }
  for (const Interferer& ship : s.interferers) {
    const Kinematics k = ship.track.at(0.0);
    text += fmt::format("interferer {}: {}, {}, {}{}\n", ship.name, position(k.position),
                        motion(k.velocity), ship.level_db || ship.table ? "broadband, " : "",
                        count_of(ship.tonals.size(), "tonal"));
  }
  text += noise_text(simulator);
  text += reverberation_text(s, simulator.ground_spacing());
  return text;
}

std::string size_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const PingSchedule& p = s.pings;
  const double rate = recorded_rate(s);
  const bool complex = p.samples == Samples::baseband;
  const double samples = p.continuous ? static_cast<double>(Stream::longest_part(s))
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

std::string axis_text(const std::vector<double>& values, double unit) {
  if (values.size() == 1) return fmt::format("{:g}", values[0] / unit);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{} from {:g} to {:g}", values.size(), *low / unit, *high / unit);
}

std::string run_text(const PropagationCase& run) {
  std::string text =
      fmt::format("source     {}, {:g} Hz, at depths [m]: {}\n", name(run.beams.source),
                  run.frequency, axis_text(run.source_depths, 1.0));
  if (run.receivers.size() > 0)
    text +=
        fmt::format("receivers  {}at depths [m]: {}, ranges [km]: {}\n",
                    run.receivers.irregular ? "one by one, " : "",
                    axis_text(run.receivers.depths, 1.0), axis_text(run.receivers.ranges, 1000.0));
  text += fmt::format("fan        {:g} to {:g} deg\n", degrees(run.beams.lowest),
                      degrees(run.beams.highest));
  text += fmt::format("task       {}", name(run.task));
  if (run.task == Task::field)
    text += fmt::format(", {}, {} beams", name(run.field), name(run.beams.kind));
  return text + "\n";
}

/// An ocean and a run of the propagation model, without a sonar.
int validate_run(const ScenarioChoice& choice) {
  std::vector<std::string> notes;
  const PropagationCase run = read_propagation_case(choice.path, choice.overrides, notes);
  print(emphasised(run.title.empty() ? choice.path : run.title) + '\n');
  print(environment_text(run.environment, run.frequency, std::nullopt) + run_text(run));
  for (const std::string& note : notes) print("note: " + note + '\n');
  print(choice.path + ": good\n");
  return 0;
}

int validate(const ScenarioChoice& choice) {
  if (!has_sonar(choice.path, choice.overrides)) return validate_run(choice);
  const PingSimulator simulator(read_scenario(choice.path, choice.overrides));
  const Scenario& scenario = simulator.scenario();
  print(emphasised(scenario.title.empty() ? scenario.path : scenario.title) + '\n');
  print(environment_text(scenario.environment, simulator.pulse().centre_frequency(),
                         scenario.wind_speed) +
        transect_text(simulator) + sonar_text(simulator) + size_text(simulator));
  for (const std::string& note : scenario.notes) print("note: " + note + '\n');
  print(choice.path + ": good\n");
  return 0;
}

}  // namespace

void add_validate_command(CLI::App& program, Action& action) {
  auto choice = std::make_shared<ScenarioChoice>();
  CLI::App* command = program.add_subcommand(
      "validate", "Read and check a scenario or a run, and say what it means.");
  add_scenario_options(*command, *choice);
  command->footer(
      "Exit status: 0 good, 2 not.\n"
      "Example:  asdic validate scenarios/deep_ocean.toml --set pings.count=100");
  command->callback([choice, &action] { action = [choice] { return validate(*choice); }; });
}

}  // namespace asdic::app
