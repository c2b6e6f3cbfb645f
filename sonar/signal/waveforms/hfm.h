#pragma once
#include <algorithm>
#include <string_view>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// A sweep whose period is linear in time, 1/f = 1/f₁ + bt with b = (1/f₂ − 1/f₁)/T: a target's
/// motion shifts its echo, and does not spoil it. φ(t) = 2π ln(1 + bf₁t)/b.
/// Kroszczyński, Proc. IEEE 57, 1260 (1969).
struct Hfm {
  static constexpr std::string_view name = "hfm", title = "HFM";
  double start_frequency = 3950.0;  ///< f₁, at the leading edge [Hz]
  double end_frequency = 4050.0;    ///< f₂, at the trailing edge; below f₁ of a down-sweep [Hz]

  void describe(Fields& field);
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {std::min(start_frequency, end_frequency), std::max(start_frequency, end_frequency)};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const Hfm&) const = default;
};
static_assert(PhaseWaveform<Hfm>);

}  // namespace asdic::detail
