#pragma once
#include <algorithm>
#include <string_view>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// Linear sweeps one after another, each as the first (a pulse train of frequency modulation): the
/// frequency is a sawtooth, the phase goes on without a jump. It repeats every T/n about its middle
/// frequency, so its spectrum is a comb, lines n/T apart.
/// Doisy et al., IEEE J. Ocean. Eng. 33, 419 (2008).
struct Ptfm {
  static constexpr std::string_view name = "ptfm", title = "PTFM";
  double start_frequency = 3950.0;  ///< f₁, where each sweep begins [Hz]
  double end_frequency = 4050.0;    ///< f₂, where it ends [Hz]
  int sweeps = 10;                  ///< n, within the duration

  void describe(Fields& field);
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {std::min(start_frequency, end_frequency), std::max(start_frequency, end_frequency)};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const Ptfm&) const = default;
};
static_assert(PhaseWaveform<Ptfm>);

}  // namespace asdic::detail
