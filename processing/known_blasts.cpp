#include "processing/known_blasts.h"

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail {
namespace {

constexpr double moment_step = 0.1;       // [s]
constexpr double faintest_db = -70.0;     // of a path, below all of them
constexpr double long_pulse = 0.1;        // of the time that a ping is received
constexpr double slowest_sound = 1400.0;  // [m/s]

const Replica& pulse_of_all(std::span<const Replica> pulses, int transmitter) {
  return pulses[pulses.size() > 1 ? static_cast<std::size_t>(transmitter) : 0];
}

Arrivals straight_ways(const BlastSearch& search, const PingGeometry& geometry, double frequency) {
  const Vec3 from = geometry.source().position;
  const Carried& reference = geometry.reference(search.array);
  Vec3 to = reference.at(geometry.time()).position;
  for (int i = 0; i < 2; ++i)  // where it is when the sound comes
    to = reference.at(geometry.time() + (to - from).norm() / 1500.0).position;
  const PropagationSettings& settings = search.scenario.propagation;
  const Bounces enough =
      enough_bounces(search.paths, settings, from, to, frequency, end_of_record(search.scenario));
  return search.paths.find(from, to, frequency, limits_of(settings, enough));
}

/// How far phones are from where the sender was, against the reference place. \param offset  of the
/// transmission's start from the ping's [s]
void add_moments(const BlastSearch& search, const PingGeometry& geometry, double offset,
                 double travel, double duration, KnownBlast& blast) {
  const Carried& reference = geometry.reference(search.array);
  const ArrayMotion& motion = geometry.motion(search.array);
  const Vec3 to = reference.at(geometry.time() + travel).position;
  const double whole = separation(geometry.source().position, to).range;
  const auto count = static_cast<std::size_t>(std::ceil((duration + 2.0) / moment_step)) + 1;
  blast.range.assign(search.phones.size(), {});
  blast.depth.assign(search.phones.size(), {});
  for (std::size_t i = 0; i < count; ++i) {
    const double since = travel - 1.0 + static_cast<double>(i) * moment_step;  // it was sent
    blast.moments.push_back(offset + since);
    const Vec3 from = geometry.source_at(since - travel).position;
    const Vec3 at = reference.at(geometry.time() + since).position;
    const std::vector<Vec3> phones =
        motion.deforms() ? motion.phones(search.ping, geometry.time() + since) : search.phones;
    for (std::size_t n = 0; n < phones.size(); ++n) {
      const Vec3 phone = at + phones[n];
      blast.range[n].push_back(separation(from, phone).range - whole);
      blast.depth[n].push_back((phone.z() - from.z()) - (to.z() - geometry.source().position.z()));
    }
  }
}

/// The transmissions of which a record may hold something, with their pings' numbers.
std::vector<std::pair<int, Transmission>> sent_into(const BlastSearch& search) {
  if (!search.scenario.pings.continuous)  // one on command may have any number
    return {{search.ping, {.transmitter = search.transmitter, .time = search.ping_time}}};
  std::vector<std::pair<int, Transmission>> result;
  for (const Transmission& one : transmissions(search.scenario))
    result.emplace_back(static_cast<int>(result.size()) + 1, one);
  return result;
}

}  // namespace

bool is_own(const Scenario& scenario, int transmitter, int array) noexcept {
  return scenario.transmitters[static_cast<std::size_t>(transmitter)].platform ==
         scenario.arrays[static_cast<std::size_t>(array)].platform;
}

bool is_blanked(const Scenario& scenario, int transmitter, int array) noexcept {
  return scenario.pings.blanking && is_own(scenario, transmitter, array);
}

bool sends_on(const Scenario& scenario, int transmitter, int array, double duration) noexcept {
  return scenario.pings.continuous && !is_blanked(scenario, transmitter, array) &&
         duration > long_pulse * scenario.pings.recording_duration;
}

std::vector<KnownBlast> known_blasts(const BlastSearch& search, std::span<const Replica> pulses,
                                     bool all) {
  std::vector<KnownBlast> found;
  for (const auto& [ping, one] : sent_into(search)) {
    const Replica& pulse = pulse_of_all(pulses, one.transmitter);
    if (is_blanked(search.scenario, one.transmitter, search.array)) continue;
    if (!all && !sends_on(search.scenario, one.transmitter, search.array, pulse.duration()))
      continue;
    const double offset = one.time - search.ping_time;
    if (offset > search.end || offset + search.scenario.pings.recording_duration < search.start)
      continue;
    const PingGeometry geometry(search.scenario, one, ping);
    const Arrivals ways = straight_ways(search, geometry, pulse.centre_frequency());
    double sum = 0.0;
    for (const Arrival& way : ways) sum += std::norm(way.amplitude) + way.scattered;
    KnownBlast blast;
    blast.pulse = &pulse;
    const Arrival* loudest = nullptr;
    for (const Arrival& way : ways) {
      const double power = std::norm(way.amplitude) + way.scattered;
      if (!(power > sum * power_from_db(faintest_db))) continue;
      if (loudest == nullptr || power > std::norm(loudest->amplitude) + loudest->scattered)
        loudest = &way;
      if (offset + way.delay + pulse.duration() < search.start || offset + way.delay > search.end)
        continue;
      blast.paths.push_back(
          {.delay = offset + way.delay,
           .slowness = way.horizontal_slowness,
           .slowness_down = -way.horizontal_slowness * std::tan(way.arrival_elevation),
           .power = power});
    }
    if (blast.paths.empty()) continue;
    const double latest =
        std::max_element(ways.begin(), ways.end(), [](const Arrival& a, const Arrival& b) {
          return a.delay < b.delay;
        })->delay;
    add_moments(search, geometry, offset, loudest->delay,
                pulse.duration() + latest - loudest->delay, blast);
    found.push_back(std::move(blast));
  }
  return found;
}

std::vector<std::pair<double, double>> blanked_times(const BlastSearch& search,
                                                     std::span<const Replica> pulses) {
  std::vector<std::pair<double, double>> times;
  for (const auto& [ping, one] : sent_into(search)) {
    if (!is_blanked(search.scenario, one.transmitter, search.array)) continue;
    const double from = one.time - search.ping_time;
    const double to = from + pulse_of_all(pulses, one.transmitter).duration();
    if (to > search.start && from < search.end) times.emplace_back(from, to);
  }
  return times;
}

double first_sound(const BlastSearch& search, const Replica& pulse) {
  if (is_own(search.scenario, search.transmitter, search.array)) return 0.0;
  const PingGeometry geometry(
      search.scenario, {.transmitter = search.transmitter, .time = search.ping_time}, search.ping);
  const Arrivals ways = straight_ways(search, geometry, pulse.centre_frequency());
  // No way at all: as if it were straight.
  double first =
      (geometry.source().position - geometry.reference(search.array).at(search.ping_time).position)
          .norm() /
      1550.0;
  if (!ways.empty()) first = ways.front().delay;
  double aperture = 0.0;
  for (const Vec3& phone : search.phones) aperture = std::max(aperture, phone.norm());
  return std::max(0.0, first - aperture / slowest_sound);
}

}  // namespace asdic::detail
