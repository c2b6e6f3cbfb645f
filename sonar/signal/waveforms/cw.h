#pragma once
#include <string_view>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// A tone: φ(t) = 2πft.
struct Cw {
  static constexpr std::string_view name = "cw", title = "CW";
  double frequency = 4000.0;  ///< f [Hz]

  void describe(Fields& field);
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {frequency, frequency};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const Cw&) const = default;
};
static_assert(PhaseWaveform<Cw>);

}  // namespace asdic::detail
