#include "io/scenario/checks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/fields.h"
#include "core/text.h"
#include "io/climatology/sources.h"
#include "io/scenario/area.h"
#include "io/scenario/propagation.h"
#include "io/scenario/sections.h"
#include "raytrace/area/earth_places.h"
#include "sonar/ping/ping_memory.h"
#include "sonar/ping/stream_parts.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmission.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail::scenario {
namespace {

/// One moment of a track that could be its worst.
struct Moment {
  double time;
  std::string key;  // of the scenario that places it there
};

/// Where and when a track, moved by an offset, passes the nodes of the boundaries: between them it
/// and the sea floor are straight. A smooth boundary is looked at in eight places more a facet.
void add_nodes(const Scenario& scenario, const Track& track, const Vec3& offset, double from,
               double to, const std::string& key, std::vector<Moment>& moments) {
  const auto x_at = [&](double time) {
    const Vec3 place = track.at(time).position + offset;
    return scenario.transect.range_of(place.x(), place.y());
  };
  const double begin = x_at(from), end = x_at(to);
  std::vector<double> places;
  for (const Boundary* boundary : {&scenario.environment.surface, &scenario.environment.bottom}) {
    if (!boundary->shape) continue;
    const auto nodes = boundary->shape->ranges();
    const int parts =
        boundary->shape->interpolation() == ShapeInterpolation::piecewise_linear ? 1 : 8;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int part = 0; part < (i + 1 < nodes.size() ? parts : 1); ++part)
        places.push_back(part == 0 ? nodes[i] : std::lerp(nodes[i], nodes[i + 1], part / 8.0));
  }
  for (const double x : places)
    if ((x - begin) * (x - end) < 0.0)
      moments.push_back({from + (to - from) * (x - begin) / (end - begin), key});
  if (!scenario.area) return;
  // Over a map: at every half step of its grid.
  const Vec2 first = (track.at(from).position + offset).head<2>();
  const double way = (track.at(to).position - track.at(from).position).head<2>().norm();
  constexpr double most = 100e3;
  const double pieces = std::min(most, std::ceil(2.0 * way / scenario.area->spacing(first)));
  for (double piece = 1.0; piece < pieces; piece += 1.0)
    moments.push_back({std::lerp(from, to, piece / pieces), key});
}

/// All that could be the worst of a track, moved by an offset: its ends, its waypoints, and where
/// it passes the nodes of the boundaries.
std::vector<Moment> moments(const Scenario& scenario, const Track& track, const Vec3& offset,
                            TomlTable& table, double from, double to) {
  const std::string start = !track.waypoints.empty() ? "waypoints"
                            : table.has("position")  ? "position"
                                                     : "depth";
  const std::string end = track.waypoints.empty() && table.has("velocity") ? "velocity" : start;
  std::vector<Moment> result{{from, start}, {to, end}};
  for (std::size_t i = 0; i < track.waypoints.size(); ++i)
    if (track.waypoints[i].time > from && track.waypoints[i].time < to)
      result.push_back({track.waypoints[i].time, "waypoints[" + std::to_string(i) + "]"});
  const auto earlier = [](const Moment& a, const Moment& b) { return a.time < b.time; };
  std::stable_sort(result.begin(), result.end(), earlier);
  const std::vector<Moment> straight = result;
  for (std::size_t i = 1; i < straight.size(); ++i)
    add_nodes(scenario, track, offset, straight[i - 1].time, straight[i].time, straight[i].key,
              result);
  std::stable_sort(result.begin(), result.end(), earlier);
  return result;
}

std::string at_time(double time) { return " at " + to_text(time) + " s"; }

/// The water over one place of the map.
class WaterColumn {
 public:
  WaterColumn(const Scenario& scenario, const Vec3& place)
      : scenario_(&scenario),
        varies_(scenario.environment.surface.shape || scenario.environment.bottom.shape),
        area_(scenario.area != nullptr),
        on_map_(!area_ || scenario.area->floor().covers(place.x(), place.y())),
        place_(place),
        x_(scenario.transect.range_of(place.x(), place.y())),
        top_(ocean_on_map(scenario).surface_depth(place)),
        bottom_(ocean_on_map(scenario).bottom_depth(place)) {}

  [[nodiscard]] bool holds(double depth) const {
    return on_map_ && depth > top_ && depth < bottom_;
  }
  [[nodiscard]] std::string expected() const {
    const std::string where = area_ ? where_on_map() : "";
    if (!on_map_)
      return "a place on the map of environment.area.bathymetry (" +
             scenario_->area->floor().name() + ", " + extent_text(scenario_->area->floor()) +
             "), not " + where;
    if (area_ && bottom_ <= top_) return "a place at sea: " + where + " is land" + land_text();
    const std::string between = "a depth between the surface (" + rounded(top_) +
                                " m) and the bottom (" + rounded(bottom_) + " m)";
    if (area_) return between + " there, " + where;
    return between +
           (varies_ ? " there, " + to_text(std::round(x_)) + " m along the transect" : "");
  }

 private:
  /// "1000 m east, 0 m north (40 N -19.9883 E)"
  [[nodiscard]] std::string where_on_map() const {
    std::string where = to_text(std::round(place_.x())) + " m east, " +
                        to_text(std::round(place_.y())) + " m north";
    const EarthPlaces earth(scenario_->origin, scenario_->area.get());
    if (!earth.known()) return where;
    const GeographicPlace there = earth.at(place_.x(), place_.y());
    const auto rounded_degree = [](double degree) { return std::round(1e4 * degree) / 1e4; };
    return where + " (" +
           climatology::place(rounded_degree(there.latitude),
                              rounded_degree(std::remainder(there.longitude, 360.0))) +
           ")";
  }
  /// Whose word it is, and what may be wrong about it.
  [[nodiscard]] std::string land_text() const {
    const ScalarMap& floor = scenario_->area->floor();
    const double height = top_ - floor.at(place_.x(), place_.y()).value;
    std::string text =
        ", " + to_text(std::round(10.0 * height) / 10.0) + " m high, by " + floor.name();
    if (seems_all_land(floor))
      text +=
          "; all of that map seems to be land: if its values are depths, the variable's name, "
          "standard_name or long_name says so with the word \"depth\"";
    return text;
  }
  [[nodiscard]] std::string rounded(double depth) const {
    return to_text(varies_ || area_ ? std::round(10.0 * depth) / 10.0 : depth);
  }

  const Scenario* scenario_;
  bool varies_, area_, on_map_;
  Vec3 place_;
  double x_, top_, bottom_;
};

/// When a run's ping is sent, and when its record ends [s].
struct PingTimes {
  double sent, end;
};
std::vector<PingTimes> ping_times(const Scenario& scenario) {
  std::vector<PingTimes> times;
  for (const Transmission& sent : transmissions(scenario))
    times.push_back({sent.time, sent.time + scenario.pings.recording_start +
                                    scenario.pings.recording_duration});
  return times;
}

/// Something that a platform carries, `offset` from it, stays in the water.
void check_carried(
    const Scenario& scenario, int platform, const Vec3& offset, double end,
    TomlTable& platform_table,
    const std::function<InputError(const Moment&, const WaterColumn&, double)>& fault) {
  const Track& track = scenario.platforms[static_cast<std::size_t>(platform)].track;
  for (const Moment& moment : moments(scenario, track, offset, platform_table, 0.0, end)) {
    const Vec3 place = track.at(moment.time).position + offset;
    const WaterColumn water(scenario, place);
    if (!water.holds(place.z())) throw fault(moment, water, place.z());
  }
}

std::string depth_at_time(double depth, double time) {
  return "depth " + to_text(depth) + " m" + at_time(time);
}

/// An array whose shape changes is looked at when each ping is sent.
void check_shapes(const Scenario& scenario, int array, TomlTable& table) {
  const ArrayMotion motion(scenario, array);
  int ping = 0;
  for (const Transmission& sent : transmissions(scenario)) {
    const Vec3 reference = motion.at(sent.time).position;
    int phone = 0;
    for (const Vec3& offset : motion.phones(++ping, sent.time)) {
      const Vec3 place = reference + offset;
      const WaterColumn water(scenario, place);
      if (!water.holds(place.z()))
        throw table.fault(
            table.has("shapes") ? "shapes" : "behind", water.expected(),
            "phone " + std::to_string(phone) + " at " + depth_at_time(place.z(), sent.time));
      ++phone;
    }
  }
}

void check_platforms(TomlTable& root, const Scenario& scenario) {
  std::vector<TomlTable> platforms = root.one_or_more("platform"),
                         transmitters = root.one_or_more("transmitter"),
                         arrays = root.one_or_more("array");
  double end = 0.0;
  for (const PingTimes& ping : ping_times(scenario)) end = std::max(end, ping.end);
  for (std::size_t i = 0; i < transmitters.size(); ++i) {
    const Transmitter& transmitter = scenario.transmitters[i];
    TomlTable& carrier = platforms[static_cast<std::size_t>(transmitter.platform)];
    check_carried(scenario, transmitter.platform, transmitter.offset, end, carrier,
                  [&](const Moment& moment, const WaterColumn& water, double depth) {
                    const std::string got = depth_at_time(depth, moment.time);
                    return transmitters[i].has("offset")
                               ? transmitters[i].fault("offset", water.expected(), got)
                               : carrier.fault(moment.key, water.expected(), got);
                  });
  }
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const ReceiverArray& array = scenario.arrays[i];
    if (array.towed || !array.shapes.empty()) {
      check_shapes(scenario, static_cast<int>(i), arrays[i]);
      continue;
    }
    for (std::size_t n = 0; n < array.phones.size(); ++n)
      check_carried(scenario, array.platform, array.offset + array.phones[n], end,
                    platforms[static_cast<std::size_t>(array.platform)],
                    [&](const Moment& moment, const WaterColumn& water, double depth) {
                      return arrays[i].fault(arrays[i].has("positions") ? "positions" : "phones",
                                             water.expected(),
                                             "phone " + std::to_string(n) + " at " +
                                                 depth_at_time(depth, moment.time));
                    });
  }
}

void check_targets(TomlTable& root, const Scenario& scenario) {
  auto tables = root.tables("target");
  const std::vector<PingTimes> times = ping_times(scenario);
  const std::vector<Transmission> sent = transmissions(scenario);
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const Target& target = scenario.targets[i];
    if (target.first_ping > std::ssize(times)) continue;
    const int last = std::min(target.last_ping, static_cast<int>(times.size()));
    const double from = times[static_cast<std::size_t>(target.first_ping - 1)].sent;
    for (const Moment& moment : moments(scenario, target.track, Vec3::Zero(), tables[i], from,
                                        times[static_cast<std::size_t>(last - 1)].end)) {
      const Vec3 place = target.track.at(moment.time).position;
      const WaterColumn water(scenario, place);
      if (!water.holds(place.z()))
        throw tables[i].fault(moment.key, water.expected(), depth_at_time(place.z(), moment.time));
    }
    for (int ping = target.first_ping; ping <= last; ++ping) {
      const Transmission& one = sent[static_cast<std::size_t>(ping - 1)];
      const Vec3 source = transmitter_at(scenario, one.transmitter, one.time).position;
      const double distance = (target.track.at(one.time).position - source).norm();
      if (distance < 1.0)  // levels refer to 1 m
        throw tables[i].fault(
            moments(scenario, target.track, Vec3::Zero(), tables[i], from, from)[0].key,
            "a target at least 1 m from the " +
                std::string(scenario.transmitters.size() > 1 ? "transmitter" : "platform"),
            to_text(distance) + " m" + at_time(one.time));
    }
  }
}

/// Interfering ships are in the water as long as there is sound that is recorded.
void check_interferers(TomlTable& root, const Scenario& scenario) {
  auto tables = root.tables("interferer");
  double end = 0.0;
  for (const PingTimes& ping : ping_times(scenario)) end = std::max(end, ping.end);
  for (std::size_t i = 0; i < scenario.interferers.size(); ++i) {
    const Track& track = scenario.interferers[i].track;
    for (const Moment& moment : moments(scenario, track, Vec3::Zero(), tables[i], 0.0, end)) {
      const Vec3 place = track.at(moment.time).position;
      const WaterColumn water(scenario, place);
      if (!water.holds(place.z()))
        throw tables[i].fault(moment.key, water.expected(), depth_at_time(place.z(), moment.time));
    }
  }
}

/// fs > 2·(f_c + B/2)·η_max, B the width outside which the pulse's spectrum is 40 dB down: what the
/// synthesizer asks for as well.
void check_sampling(TomlTable& root, const Scenario& scenario, const PulseSettings& settings) {
  const double rate = recorded_rate(scenario);
  TomlTable pings = root.table("pings");
  if (scenario.pings.samples == Samples::baseband) {
    const Band band = received_band(scenario, Pulse(settings));
    const double carrier = recorded_carrier(scenario);
    const double needed = 2.0 * std::max(band.highest - carrier, carrier - band.lowest);
    if (rate < needed)
      throw pings.fault(pings.has("baseband_rate") ? "baseband_rate" : "carrier",
                        "a baseband rate of at least " + to_text(std::ceil(needed)) +
                            " Hz: the pulse's band with its Doppler shift about a carrier of " +
                            to_text(std::round(10.0 * carrier) / 10.0) + " Hz",
                        to_text(rate) + " Hz");
    return;
  }
  const auto through = frequencies_of(settings.waveform, settings.duration);
  double highest = through ? through->highest * (1.0 + doppler_bound(scenario)) : 0.0;
  if (rate > 2.0 * highest)  // else it is too slow without a spectrum
    highest = received_band(scenario, Pulse(settings)).highest;
  if (!(rate > 2.0 * highest))
    throw pings.fault("sample_rate",
                      "a sample rate above " + to_text(std::ceil(2.0 * highest)) +
                          " Hz: twice the highest frequency of the pulse with its Doppler shift",
                      to_text(rate) + " Hz");
}

void check_size(TomlTable& root, const Scenario& scenario) {
  const double rate = recorded_rate(scenario);
  const std::size_t longest = scenario.pings.continuous ? longest_stream_part(scenario) : 0;
  const double samples =
      std::max(scenario.pings.recording_duration * rate, static_cast<double>(longest));
  TomlTable pings = root.table("pings");
  if (samples < 2.0)
    throw pings.fault("recording_duration", "at least two samples",
                      to_text(samples / rate) + " s at " + to_text(rate) + " Hz");
  const double end = scenario.pings.recording_start + scenario.pings.recording_duration;
  if (scenario.pulse.duration > end) {
    TomlTable pulse = root.table("pulse");
    throw pulse.fault(pulse.has("file") ? "file" : "duration",
                      "a pulse no longer than the record, " + to_text(end) + " s",
                      to_text(scenario.pulse.duration) + " s");
  }
  constexpr double most = 1e9;  // lengths of transforms are whole numbers of 32 bits
  if (samples > most)
    throw pings.fault("recording_duration", "at most 1e9 samples a phone",
                      to_text(samples / rate) + " s at " + to_text(rate) + " Hz");
  TomlTable run = root.table("run");
  MemoryBudget budget = MemoryBudget::of(read_memory(run));  // here, where the line is known
  budget.take(record_need(scenario, samples, pings.where("recording_duration")));
}

void check_dimension(TomlTable& root, const Scenario& scenario) {
  if (scenario.propagation.dimension == 3 && scenario.environment.surface.shape)
    throw root.table("propagation")
        .fault("dimension",
               "2: rays in three dimensions know a flat surface only, and environment.surface has "
               "a shape",
               "3");
}

void check_fathometer(TomlTable& root, const Scenario& scenario) {
  if (scenario.propagation.fathometer && scenario.propagation.dimension != 3 &&
      ocean_on_map(scenario).varies())
    throw root.table("propagation")
        .fault("fathometer",
               "false where the ocean varies along a transect, or propagation.dimension = 3: a "
               "mirror that slopes is not in the plane of transmitter and array",
               "true");
}

/// A projector sends one pulse at a time.
void check_intervals(TomlTable& root, const Scenario& scenario) {
  if (scenario.pings.count < 2) return;
  std::vector<TomlTable> transmitters = root.one_or_more("transmitter");
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const double interval = scenario.transmitters[t].interval.value_or(scenario.pings.interval),
                 duration = Pulse(pulse_of(scenario, static_cast<int>(t))).duration();
    if (interval >= duration) continue;
    const TomlTable pings = root.table("pings");
    const TomlTable& table = scenario.transmitters[t].interval ? transmitters[t] : pings;
    throw table.fault("interval",
                      "an interval of at least the pulse's duration, " + to_text(duration) +
                          " s: a projector sends one pulse at a time",
                      to_text(interval) + " s");
  }
}

}  // namespace

void check_coherence(const TomlTable& noise, const Scenario& scenario) {
  constexpr std::size_t most_phones = 256;  // the factors of more are gigabytes
  const NoiseCoherence coherence = scenario.noise.coherence;
  if (coherence == NoiseCoherence::independent) return;
  for (const ReceiverArray& array : scenario.arrays)
    if (array.phones.size() > most_phones)
      throw noise.fault(
          "coherence",
          "\"independent\" for an array of more than " + std::to_string(most_phones) + " phones",
          in_quotes(word_of(coherence)) + " for " + std::to_string(array.phones.size()));
}

void check_scenario(TomlTable& root, const Scenario& scenario) {
  check_platforms(root, scenario);
  check_targets(root, scenario);
  check_interferers(root, scenario);
  check_size(root, scenario);
  check_dimension(root, scenario);
  check_fathometer(root, scenario);
  check_intervals(root, scenario);
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t)
    check_sampling(root, scenario, pulse_of(scenario, static_cast<int>(t)));
}

}  // namespace asdic::detail::scenario
