#pragma once
#include <algorithm>
#include <string_view>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// Short pulses, a tone or a sweep each, with silence between them; the first begins with the
/// train, the last ends with it. All are keyed out of one oscillator: their envelopes about the
/// middle frequency are the same. The window is that of each. Its ambiguity function is a bag of
/// nails. Rihaczek, Principles of High-Resolution Radar (1969), ch. 6.
struct PulseTrain {
  static constexpr std::string_view name = "pulse_train", title = "pulse train";
  double start_frequency = 3950.0;  ///< where each begins [Hz]
  double end_frequency = 4050.0;    ///< where each ends; the same of tones [Hz]
  int pulses = 5;                   ///< N
  double pulse_duration = 0.05;     ///< of each [s]

  void describe(Fields& field);
  void check(Fields& field, double duration) const;
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {std::min(start_frequency, end_frequency), std::max(start_frequency, end_frequency)};
  }
  [[nodiscard]] Repeats repeats(double duration) const noexcept {
    return {.count = pulses,
            .duration = pulse_duration,
            .interval = (duration - pulse_duration) / (pulses - 1)};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const PulseTrain&) const = default;
};
static_assert(PhaseWaveform<PulseTrain>);

}  // namespace asdic::detail
