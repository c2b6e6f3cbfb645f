#include "sonar/scenario/sampling.h"

#include <algorithm>
#include <cmath>

#include "sonar/scenario/ping_bounds.h"

namespace asdic::detail {
namespace {

/// Of all transmitters' pulses together.
Band band_of_all(const Scenario& scenario) {
  Band all{.lowest = infinity, .highest = 0.0};
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const Band one = received_band(scenario, Pulse(pulse_of(scenario, static_cast<int>(t))));
    all.lowest = std::min(all.lowest, one.lowest);
    all.highest = std::max(all.highest, one.highest);
  }
  return all;
}

}  // namespace

Band received_band(const Scenario& scenario, const Pulse& pulse) {
  const double doppler = doppler_bound(scenario), half = 0.5 * pulse.bandwidth_40db();
  return {.lowest = (pulse.centre_frequency() - half) * (1.0 - doppler),
          .highest = (pulse.centre_frequency() + half) * (1.0 + doppler)};
}

double recorded_carrier(const Scenario& scenario) {
  const PingSchedule& schedule = scenario.pings;
  if (schedule.samples == Samples::pressure) return 0.0;
  if (schedule.carrier) return *schedule.carrier;
  if (scenario.transmitters.size() == 1) return Pulse(pulse_of(scenario, 0)).centre_frequency();
  const Band band = band_of_all(scenario);
  return 0.5 * (band.lowest + band.highest);
}

double recorded_rate(const Scenario& scenario) {
  const PingSchedule& schedule = scenario.pings;
  if (schedule.samples == Samples::pressure) return schedule.sample_rate;
  if (schedule.baseband_rate) return *schedule.baseband_rate;
  const double carrier = recorded_carrier(scenario), doppler = doppler_bound(scenario);
  double furthest = 0.0;
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const Pulse pulse(pulse_of(scenario, static_cast<int>(t)));
    constexpr double for_filter =
        1.35;  // BandLimitedPulse: flat over 1/1.3 of what it lets through
    const double f = pulse.centre_frequency(), half = 0.5 * for_filter * pulse.sampled_bandwidth();
    furthest = std::max(
        {furthest, (f + half) * (1.0 + doppler) - carrier, carrier - (f - half) * (1.0 - doppler)});
  }
  return std::ceil(2.0 * furthest);
}

Recording recording_of(const Scenario& scenario) {
  const double rate = recorded_rate(scenario);
  return {
      .sample_rate = rate,
      .start = scenario.pings.recording_start,
      .samples = static_cast<std::size_t>(std::llround(scenario.pings.recording_duration * rate)),
      .carrier = recorded_carrier(scenario)};
}

}  // namespace asdic::detail
