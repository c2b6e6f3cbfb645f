#include <algorithm>
#include <cmath>

#include "io/scenario/sections.h"

namespace asdic::scenario {
namespace {

/// Over a bottom that is not flat a straight track is looked at this often besides its ends.
int looks_between(const Environment& ocean) {
  return ocean.surface.shape || ocean.bottom.shape ? 200 : 0;
}

/// One moment of a track that could be its worst: tracks are straight between these.
struct Moment {
  double time;
  std::string key;  // of the scenario that places it there
};

std::vector<Moment> moments(const Track& track, TomlTable& table, double from, double to,
                            int between = 0) {
  const std::string start = !track.waypoints.empty() ? "waypoints"
                            : table.has("position")  ? "position"
                                                     : "depth";
  const std::string end = track.waypoints.empty() && table.has("velocity") ? "velocity" : start;
  std::vector<Moment> result{{from, start}, {to, end}};
  for (std::size_t i = 0; i < track.waypoints.size(); ++i)
    if (track.waypoints[i].time > from && track.waypoints[i].time < to)
      result.push_back({track.waypoints[i].time, "waypoints[" + std::to_string(i) + "]"});
  for (int i = 1; i <= between; ++i)
    result.push_back({from + (to - from) * i / (between + 1.0), end});
  std::sort(result.begin(), result.end(),
            [](const Moment& a, const Moment& b) { return a.time < b.time; });
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

/// The water above and below a place of the map.
class WaterColumn {
 public:
  WaterColumn(const Scenario& scenario, const Vec3& place) {
    const Environment& ocean = scenario.environment;
    const double range = scenario.transect.range_of(place.x(), place.y());
    top_ = ocean.surface.depth_at(range);
    bottom_ = ocean.bottom.depth_at(range);
  }

  [[nodiscard]] bool holds(double depth) const { return depth > top_ && depth < bottom_; }
  [[nodiscard]] std::string expected() const {
    return "a depth between the surface (" + to_text(top_) + " m) and the bottom (" +
           to_text(bottom_) + " m)";
  }

 private:
  double top_ = 0.0, bottom_ = 0.0;
};

std::string at_time(double time) { return " at " + to_text(time) + " s"; }

/// End of the last record [s].
double end_of(const PingSchedule& pings, int last_ping) {
  return (last_ping - 1) * pings.interval + pings.recording_start + pings.recording_duration;
}

void check_platform(TomlTable& root, const Scenario& scenario) {
  TomlTable platform = root.table("platform"), array = root.table("array");
  for (const Moment& moment :
       moments(scenario.platform, platform, 0.0, end_of(scenario.pings, scenario.pings.count),
               looks_between(scenario.environment))) {
    const Vec3 place = scenario.platform.at(moment.time).position;
    const double depth = place.z();
    const WaterColumn water(scenario, place);
    if (!water.holds(depth))
      throw platform.fault(moment.key, water.expected(),
                           "depth " + to_text(depth) + " m" + at_time(moment.time));
    for (std::size_t i = 0; i < scenario.array.phones.size(); ++i) {
      const double phone = depth + scenario.array.offset.z() + scenario.array.phones[i].z();
      if (!water.holds(phone))
        throw array.fault(array.has("positions") ? "positions" : "phones", water.expected(),
                          "phone " + std::to_string(i) + " at depth " + to_text(phone) + " m" +
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
    for (const Moment& moment : moments(target.track, tables[i], from, end_of(scenario.pings, last),
                                        looks_between(scenario.environment))) {
      const Vec3 place = target.track.at(moment.time).position;
      const double depth = place.z();
      const WaterColumn water(scenario, place);
      if (!water.holds(depth))
        throw tables[i].fault(moment.key, water.expected(),
                              "depth " + to_text(depth) + " m" + at_time(moment.time));
    }
    for (int ping = target.first_ping; ping <= last; ++ping) {
      const double time = (ping - 1) * scenario.pings.interval;
      const double distance =
          (target.track.at(time).position - scenario.platform.at(time).position).norm();
      if (distance < 1.0)  // levels refer to 1 m
        throw tables[i].fault(moments(target.track, tables[i], from, from)[0].key,
                              "a target at least 1 m from the platform",
                              to_text(distance) + " m" + at_time(time));
    }
  }
}

double slowest(const Environment& ocean) {
  if (ocean.section)
    return *std::min_element(ocean.section->speeds().begin(), ocean.section->speeds().end());
  double least = infinity;
  for (int i = 0; i <= 100; ++i)
    least = std::min(least, ocean.water.at(ocean.bottom.depth * i / 100).c);
  return least;
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
  const double slowest_sound = slowest(scenario.environment);
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
