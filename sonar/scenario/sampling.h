#pragma once
#include "sonar/scenario/scenario.h"
#include "sonar/signal/recording.h"

namespace asdic::detail {

/// Samples per second of what a scenario records: of the pressure, or of the complex baseband [Hz].
[[nodiscard]] double recorded_rate(const Scenario& scenario);

/// The carrier of a scenario's complex baseband [Hz]: as it says, or the middle of all its pulses'
/// bands. 0 where pressure is recorded.
[[nodiscard]] double recorded_carrier(const Scenario& scenario);

/// The lowest and highest frequency that a pulse's echo has: −40 dB, with the largest Doppler
/// factor that the scenario's speeds allow [Hz].
struct Band {
  double lowest = 0.0, highest = 0.0;
};
[[nodiscard]] Band received_band(const Scenario& scenario, const Pulse& pulse);

/// Until when a ping is received in its own record, since it is sent [s].
[[nodiscard]] inline double end_of_record(const Scenario& scenario) noexcept {
  return scenario.pings.recording_start + scenario.pings.recording_duration;
}

/// A ping's own record: as long as it is received.
[[nodiscard]] Recording recording_of(const Scenario& scenario);

}  // namespace asdic::detail
