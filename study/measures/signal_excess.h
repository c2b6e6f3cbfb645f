#pragma once
#include <optional>

#include "sonar/ping/ping.h"

namespace asdic::detail::study {

/// The receiver that a signal excess is of: matched filter, conventional beam straight at the
/// echo's strongest path, threshold over the background.
struct ListeningReceiver {
  int array = 0;             ///< an index
  std::optional<int> phone;  ///< of the array alone; none: the beam of all
  double false_alarm_probability = 1e-4;
  double cells = 24.0;  ///< averaged for the background; ∞: it is known
};

/// By how much an echo is louder than what that receiver detects half of the time [dB]:
///
///   SE = EL − 10 lg(10^{(RL − G_r)/10} + 10^{(NL − G_n)/10}) − DT
///   G_n = 10 lg(E·B₄₀) + A_n,   G_r = 10 lg(E·B) + A_r
///
/// EL, RL, NL the levels of the ping's summary, E = ∫|s₊|²dt, B₄₀ the width that NL is of, B = E²
/// over ∫|S|⁴df; A_n, A_r the array gains against the scenario's noise and against reverberation
/// that comes alike from all bearings; DT of detection_threshold_db() at P_d = 0.5. Where no path
/// reaches the array −∞; NaN where another array receives the echo louder, whose levels these are.
/// docs/theory/studies.md, eq. (8)–(10).
[[nodiscard]] double detection_signal_excess_db(const PingSimulator& simulator,
                                                const PingRecord& record,
                                                const ListeningReceiver& receiver, int target);

}  // namespace asdic::detail::study
