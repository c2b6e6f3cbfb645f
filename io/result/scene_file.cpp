#include "io/result/scene_file.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/geometry.h"
#include "io/files/digest.h"
#include "io/hdf5/earth.h"
#include "io/hdf5/environment_group.h"
#include "io/hdf5/scale.h"
#include "io/ping/sections.h"
#include "processing/pulse_ambiguity.h"
#include "raytrace/ocean/slice.h"
#include "sonar/signal/pulse_spectrum.h"

namespace asdic::detail {
namespace {

constexpr int instants = 121;   // of a track
constexpr double margin = 1.1;  // past the furthest thing of interest

/// When the last record ends [s].
double end_of(const PingSchedule& pings) {
  return (pings.count - 1) * pings.interval + pings.recording_start + pings.recording_duration;
}

/// Tables of points: names, and [things, instants, 3] where they are.
class Tracks {
 public:
  Tracks(Hdf5File& file, double end, const EarthPlaces& earth)
      : file_(file), end_(end), earth_(earth) {
    std::vector<double> times;
    for (int k = 0; k < instants; ++k) times.push_back(end * k / (instants - 1));
    write_scale(file, "instant", "instant", times, "time since the start of the scenario", "s");
    if (!file.has("xyz"))
      write_scale<std::int32_t>(file, "xyz", "xyz", {0, 1, 2}, "0 east, 1 north, 2 depth");
  }

  template <class PlaceAt>
  void write(const std::string& group, const std::vector<std::string>& names,
             const PlaceAt& place_at) {
    std::vector<double> places;
    std::vector<Vec2> on_map;
    for (std::size_t i = 0; i < names.size(); ++i)
      for (int k = 0; k < instants; ++k) {
        const Vec3 place = place_at(i, end_ * k / (instants - 1));
        places.insert(places.end(), {place.x(), place.y(), place.z()});
        on_map.emplace_back(place.head<2>());
      }
    const std::string name = group + "/track";
    file_.make_group(group);
    file_.set_attribute(group, "names", names);
    if (names.empty()) return;
    file_.write<double>(name, places, {names.size(), std::size_t{instants}, 3});
    describe(file_, name, "east, north, depth from the start to the last record's end", "m");
    std::vector<std::int32_t> numbers(names.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    write_scale(file_, group + "/thing", "thing", numbers, "number of the thing, from 0");
    file_.attach_scales(name, {group + "/thing", "instant", "xyz"});
    write_on_earth(file_, earth_, group + "/", "of the track", on_map,
                   {names.size(), std::size_t{instants}}, {group + "/thing", "instant"});
  }

 private:
  Hdf5File& file_;
  double end_;
  EarthPlaces earth_;
};

template <class Things>
std::vector<std::string> names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

void write_beams(Hdf5File& file, const Scenario& scenario) {
  std::vector<double> elevation, width;
  for (const Transmitter& transmitter : scenario.transmitters) {
    const auto* const line = std::get_if<LineBeam>(&transmitter.beam);
    const bool narrow = line != nullptr && line->taper != Taper::omnidirectional;
    elevation.push_back(degrees(transmitter.elevation));
    width.push_back(narrow ? degrees(line->steered_width(transmitter.elevation))
                           : std::numeric_limits<double>::quiet_NaN());
  }
  file.write<double>("transmitters/elevation_deg", elevation, {elevation.size()});
  describe(file, "transmitters/elevation_deg", "of the beam's axis, positive up", "degree");
  file.write<double>("transmitters/beamwidth_deg", width, {width.size()});
  describe(file, "transmitters/beamwidth_deg",
           "full, at -3 dB, as it is steered; NaN of no line's beam", "degree");
}

void write_phones(Hdf5File& file, const Scenario& scenario) {
  std::vector<double> places;
  std::vector<std::int32_t> owners;
  for (int a = 0; a < static_cast<int>(scenario.arrays.size()); ++a)
    for (const Vec3& phone : phones_at(scenario, a, 1, 0.0)) {
      places.insert(places.end(), {phone.x(), phone.y(), phone.z()});
      owners.push_back(a);
    }
  file.write<double>("arrays/phone", places, {owners.size(), 3});
  describe(file, "arrays/phone", "east, north, down of the array's middle, at the start", "m");
  file.write<std::int32_t>("arrays/phone_array", owners, {owners.size()});
  describe(file, "arrays/phone_array", "number of the phone's array, from 0");
}

/// The first transmitter's pulse: its spectrum, and what its matched filter makes of its echoes.
void write_pulse(Hdf5File& file, const Scenario& scenario) {
  const PulseSettings& settings = pulse_of(scenario, 0);
  const Pulse pulse(settings);
  file.make_group("pulse");
  file.set_attribute("pulse", "transmitter", scenario.transmitters.front().name);
  file.set_attribute("pulse", "kind", title_of(settings.waveform));
  file.set_attribute("pulse", "window", word_of(settings.window));
  file.set_attribute("pulse", "centre_frequency_hz", pulse.centre_frequency());
  file.set_attribute("pulse", "bandwidth_hz", pulse.bandwidth_40db());
  file.set_attribute("pulse", "duration_s", pulse.duration());
  file.set_attribute("pulse", "energy_s", pulse.energy());

  const PulseSpectrum spectrum = pulse_spectrum(pulse, pulse.centre_frequency());
  const auto half =
      std::min(static_cast<std::ptrdiff_t>(0.75 * pulse.bandwidth_40db() / spectrum.bin_width),
               static_cast<std::ptrdiff_t>(spectrum.bins.size() / 2) - 1);
  const auto n = static_cast<std::ptrdiff_t>(spectrum.bins.size());
  std::vector<double> frequency, power;
  for (std::ptrdiff_t k = -half; k <= half; ++k) {
    frequency.push_back(pulse.centre_frequency() + static_cast<double>(k) * spectrum.bin_width);
    power.push_back(std::norm(spectrum.bins[static_cast<std::size_t>(k < 0 ? k + n : k)]));
  }
  write_scale(file, "pulse/frequency", "pulse_frequency", frequency, "of the spectrum", "Hz");
  file.write<double>("pulse/spectrum", power, {power.size()});
  describe(file, "pulse/spectrum", "energy density of the pulse, of unit peak before its window",
           "s2");
  file.attach_scales("pulse/spectrum", {"pulse/frequency"});

  const PulseAmbiguity found = pulse_ambiguity(pulse);
  write_scale(file, "pulse/delay", "ambiguity_delay", found.delays, "of the echo over the filter's",
              "s");
  write_scale(file, "pulse/doppler_factor", "ambiguity_doppler", found.dopplers,
              "of the echo over the filter's");
  file.write<double>("pulse/ambiguity", found.power, {found.dopplers.size(), found.delays.size()});
  describe(file, "pulse/ambiguity", "of the filter's answer, 1 at its echo, the most in each cell");
  file.attach_scales("pulse/ambiguity", {"pulse/doppler_factor", "pulse/delay"});
}

}  // namespace

void write_tracks(Hdf5File& file, const Scenario& scenario) {
  Tracks tracks(file, end_of(scenario.pings), {scenario.origin, scenario.area.get()});
  tracks.write("platforms", names_of(scenario.platforms), [&](std::size_t i, double time) -> Vec3 {
    return scenario.platforms[i].track.at(time).position;
  });
  tracks.write("transmitters", names_of(scenario.transmitters),
               [&](std::size_t i, double time) -> Vec3 {
                 return transmitter_at(scenario, static_cast<int>(i), time).position;
               });
  tracks.write("arrays", names_of(scenario.arrays), [&](std::size_t i, double time) -> Vec3 {
    return array_at(scenario, static_cast<int>(i), time).position;
  });
  tracks.write("targets", names_of(scenario.targets), [&](std::size_t i, double time) -> Vec3 {
    return scenario.targets[i].track.at(time).position;
  });
}

void write_scene(const std::filesystem::path& path, const Scenario& scenario) {
  Hdf5File file = Hdf5File::create(path);
  write_filetype(file, "asdic scene", "1.0");
  file.set_attribute("", "title", scenario.title);
  file.set_attribute("", "scenario_sha256", sha256(scenario.text));
  write_origin(file, attributes_of(scenario.origin));
  write_tracks(file, scenario);
  write_beams(file, scenario);
  write_phones(file, scenario);
  write_pulse(file, scenario);

  const Pulse pulse(pulse_of(scenario, 0));
  file.set_attribute("", "frequency_hz", pulse.centre_frequency());
  file.set_attribute("", "pulse_duration_s", pulse.duration());
  file.set_attribute("", "pings", std::int64_t{scenario.pings.count});
  file.set_attribute("", "end_s", end_of(scenario.pings));

  const Vec3 source = transmitter_at(scenario, 0, 0.0).position;
  double bearing = scenario.transect.bearing;
  if (!scenario.targets.empty())
    bearing = separation(source, scenario.targets.front().track.at(0.0).position).bearing;
  double extent = 0.0;
  for (const Target& target : scenario.targets)
    extent = std::max(extent, separation(source, target.track.at(0.0).position).range);
  for (int a = 0; a < static_cast<int>(scenario.arrays.size()); ++a)
    extent = std::max(extent, separation(source, array_at(scenario, a, 0.0).position).range);
  if (extent < 100.0) extent = 0.5 * 1500.0 * scenario.pings.recording_duration;
  file.set_attribute("", "bearing_deg", compass_degrees(bearing));
  const Environment plane =
      ocean_on_map(scenario).plane(source.head<2>(), bearing, margin * extent);
  const double last = margin * extent;
  write_environment_group(
      file, plane, 0.0, last,
      scenario.area ? scenario.area->reach_on_map(source.head<2>(), bearing, last) : last);
  if (scenario.area) ping_file::write_area(file, scenario);
  file.close();
}

void write_scene(const std::filesystem::path& path, const PropagationCase& run) {
  Hdf5File file = Hdf5File::create(path);
  write_filetype(file, "asdic scene", "1.0");
  file.set_attribute("", "title", run.title);
  write_origin(file, attributes_of(run.origin));
  file.set_attribute("", "frequency_hz", run.frequency);
  file.write<double>("source_depth", run.source_depths, {run.source_depths.size()});
  describe(file, "source_depth", "of the sources, at range 0", "m");
  double last = run.box_range;
  if (run.receivers.size() > 0) {
    file.write<double>("receiver_depth", run.receivers.depths, {run.receivers.depths.size()});
    describe(file, "receiver_depth", "of the receivers", "m");
    file.write<double>("receiver_range", run.receivers.ranges, {run.receivers.ranges.size()});
    describe(file, "receiver_range", "of the receivers", "m");
    file.set_attribute("", "irregular", std::int64_t{run.receivers.irregular});
    last = *std::max_element(run.receivers.ranges.begin(), run.receivers.ranges.end());
  }
  if (last <= 0.0) last = 50e3;
  write_environment_group(file, plane_of(run), 0.0, last, reach_on_map(run, last));
  file.close();
}

}  // namespace asdic::detail
