#pragma once
#include <algorithm>
#include <string_view>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// A sweep of constant rate: φ(t) = 2πt(f₁ + ½(f₂ − f₁)t/T).
struct Lfm {
  static constexpr std::string_view name = "lfm", title = "LFM";
  double start_frequency = 3950.0;  ///< f₁, at the leading edge [Hz]
  double end_frequency = 4050.0;    ///< f₂, at the trailing edge; below f₁ of a down-sweep [Hz]

  void describe(Fields& field);
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {std::min(start_frequency, end_frequency), std::max(start_frequency, end_frequency)};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const Lfm&) const = default;
};
static_assert(PhaseWaveform<Lfm>);

/// The two frequencies of a sweep, in a file not the same.
void describe_sweep(Fields& field, double& start_frequency, double& end_frequency);

}  // namespace asdic::detail
