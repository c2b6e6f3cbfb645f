#include <algorithm>
#include <cmath>

#include "io/scenario/sections.h"

namespace asdic::scenario {
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

double fastest(const Track& track) {
  if (track.waypoints.empty()) return track.start.velocity.norm();
  double speed = 0.0;
  for (std::size_t i = 1; i < track.waypoints.size(); ++i) {
    const Waypoint &a = track.waypoints[i - 1], &b = track.waypoints[i];
    speed = std::max(speed, (b.position - a.position).norm() / (b.time - a.time));
  }
  return speed;
}

std::string at_time(double time) { return " at " + to_text(time) + " s"; }

/// The water over one place of the map.
class WaterColumn {
 public:
  WaterColumn(const Scenario& scenario, const Vec3& place)
      : varies_(scenario.environment.surface.shape || scenario.environment.bottom.shape),
        x_(scenario.transect.range_of(place.x(), place.y())),
        top_(scenario.environment.surface.depth_at(x_)),
        bottom_(scenario.environment.bottom.depth_at(x_)) {}

  [[nodiscard]] bool holds(double depth) const { return depth > top_ && depth < bottom_; }
  [[nodiscard]] std::string expected() const {
    return "a depth between the surface (" + rounded(top_) + " m) and the bottom (" +
           rounded(bottom_) + " m)" +
           (varies_ ? " there, " + to_text(std::round(x_)) + " m along the transect" : "");
  }

 private:
  [[nodiscard]] std::string rounded(double depth) const {
    return to_text(varies_ ? std::round(10.0 * depth) / 10.0 : depth);
  }

  bool varies_;
  double x_, top_, bottom_;
};

/// End of the last record [s].
double end_of(const PingSchedule& pings, int last_ping) {
  return (last_ping - 1) * pings.interval + pings.recording_start + pings.recording_duration;
}

void check_platform(TomlTable& root, const Scenario& scenario) {
  TomlTable platform = root.table("platform"), array = root.table("array");
  const double end = end_of(scenario.pings, scenario.pings.count);
  for (const Moment& moment :
       moments(scenario, scenario.platform, Vec3::Zero(), platform, 0.0, end)) {
    const Vec3 place = scenario.platform.at(moment.time).position;
    const WaterColumn water(scenario, place);
    if (!water.holds(place.z()))
      throw platform.fault(moment.key, water.expected(),
                           "depth " + to_text(place.z()) + " m" + at_time(moment.time));
  }
  for (std::size_t i = 0; i < scenario.array.phones.size(); ++i) {
    const Vec3 offset = scenario.array.offset + scenario.array.phones[i];
    for (const Moment& moment : moments(scenario, scenario.platform, offset, platform, 0.0, end)) {
      const Vec3 phone = scenario.platform.at(moment.time).position + offset;
      const WaterColumn water(scenario, phone);
      if (!water.holds(phone.z()))
        throw array.fault(array.has("positions") ? "positions" : "phones", water.expected(),
                          "phone " + std::to_string(i) + " at depth " + to_text(phone.z()) + " m" +
                              at_time(moment.time));
    }
  }
}

void check_targets(TomlTable& root, const Scenario& scenario) {
  auto tables = root.tables("target");
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const Target& target = scenario.targets[i];
    if (target.first_ping > scenario.pings.count) continue;
    const int last = std::min(target.last_ping, scenario.pings.count);
    const double from = (target.first_ping - 1) * scenario.pings.interval;
    for (const Moment& moment : moments(scenario, target.track, Vec3::Zero(), tables[i], from,
                                        end_of(scenario.pings, last))) {
      const Vec3 place = target.track.at(moment.time).position;
      const WaterColumn water(scenario, place);
      if (!water.holds(place.z()))
        throw tables[i].fault(moment.key, water.expected(),
                              "depth " + to_text(place.z()) + " m" + at_time(moment.time));
    }
    for (int ping = target.first_ping; ping <= last; ++ping) {
      const double time = (ping - 1) * scenario.pings.interval;
      const double distance =
          (target.track.at(time).position - scenario.platform.at(time).position).norm();
      if (distance < 1.0)  // levels refer to 1 m
        throw tables[i].fault(
            moments(scenario, target.track, Vec3::Zero(), tables[i], from, from)[0].key,
            "a target at least 1 m from the platform", to_text(distance) + " m" + at_time(time));
    }
  }
}

double slowest_water(const Environment& ocean) {
  double slowest = infinity;
  if (ocean.section) {
    for (const double c : ocean.section->speeds()) slowest = std::min(slowest, c);
    return slowest;
  }
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  for (int i = 0; i <= 100; ++i) slowest = std::min(slowest, ocean.water.at(bottom * i / 100).c);
  return slowest;
}

/// fs > 2·(f_c + B/2)·η_max, B the width outside which the pulse's spectrum is 40 dB down: what the
/// synthesizer asks for as well.
void check_sampling(TomlTable& root, const Scenario& scenario) {
  const PulseSettings& settings = scenario.pulse;
  double highest = settings.kind == PulseKind::cw ? settings.frequency
                   : settings.kind == PulseKind::file
                       ? 0.0
                       : std::max(settings.start_frequency, settings.end_frequency);
  if (scenario.pings.sample_rate > 2.0 * highest) {  // else it is too slow without a spectrum
    const Pulse pulse(settings);
    highest = pulse.centre_frequency() + 0.5 * pulse.bandwidth_40db();
  }
  double target_speed = 0.0;
  for (const Target& target : scenario.targets)
    target_speed = std::max(target_speed, fastest(target.track));
  const double slowest_sound = slowest_water(scenario.environment);
  // η = (1 + v_T/c)(1 + v_R/c)/((1 − v_T/c)(1 − v_S/c)) ≈ 1 + 2(v_T + v_S)/c at most
  const double doppler = 1.0 + 2.0 * (target_speed + fastest(scenario.platform)) / slowest_sound;
  const double needed = 2.0 * highest * doppler;
  TomlTable pings = root.table("pings");
  if (!(scenario.pings.sample_rate > needed))
    throw pings.fault("sample_rate",
                      "a sample rate above " + to_text(std::ceil(needed)) +
                          " Hz: twice the highest frequency of the pulse with its Doppler shift",
                      to_text(scenario.pings.sample_rate) + " Hz");
}

void check_size(TomlTable& root, const Scenario& scenario) {
  constexpr double limit = 2147483648.0;  // 2 GiB
  const double samples = scenario.pings.recording_duration * scenario.pings.sample_rate;
  TomlTable pings = root.table("pings");
  if (samples < 2.0)
    throw pings.fault("recording_duration", "at least two samples",
                      to_text(scenario.pings.recording_duration) + " s at " +
                          to_text(scenario.pings.sample_rate) + " Hz");
  const double end = scenario.pings.recording_start + scenario.pings.recording_duration;
  if (scenario.pulse.duration > end) {
    TomlTable pulse = root.table("pulse");
    throw pulse.fault(pulse.has("file") ? "file" : "duration",
                      "a pulse no longer than the record, " + to_text(end) + " s",
                      to_text(scenario.pulse.duration) + " s");
  }
  const auto phones = scenario.array.phones.size();
  const double bytes = samples * static_cast<double>(phones) * sizeof(float);
  if (bytes > limit)
    throw pings.fault("recording_duration", "at most 2 GiB of pressure a ping",
                      to_text(scenario.pings.recording_duration) + " s at " +
                          to_text(scenario.pings.sample_rate) + " Hz on " + std::to_string(phones) +
                          " phones, " + to_text(std::round(bytes / 1073741824.0 * 10.0) / 10.0) +
                          " GiB a ping");
}

}  // namespace

void check_scenario(TomlTable& root, const Scenario& scenario) {
  check_platform(root, scenario);
  check_targets(root, scenario);
  check_size(root, scenario);
  check_sampling(root, scenario);
}

}  // namespace asdic::scenario
