#pragma once
#include <algorithm>
#include <string_view>
#include <vector>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// Tones at once, as loud as one another, each gap between neighbours a ratio r times the one
/// before: f_n = f₁ + (f_N − f₁)(rⁿ − 1)/(r^{N−1} − 1), n = 0…N − 1. As no two gaps are alike, a
/// Doppler shift puts at most one line on another. Phases πn²/N lower the peak by a decibel or two.
/// Cox & Lai, Proc. 28th Asilomar Conf., 1185 (1994); Boyd, IEEE Trans. CAS 33, 1018 (1986).
struct GeometricComb {
  static constexpr std::string_view name = "geometric_comb", title = "geometric comb";
  double start_frequency = 3900.0;  ///< f₁, beside the smallest gap [Hz]
  double end_frequency = 4100.0;    ///< f_N, beside the largest; above or below [Hz]
  int lines = 8;                    ///< N
  double gap_ratio = 1.2;           ///< r

  void describe(Fields& field);
  void check(Fields& field, double duration) const;
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {std::min(start_frequency, end_frequency), std::max(start_frequency, end_frequency)};
  }
  [[nodiscard]] std::vector<Tone> tones() const;
  [[nodiscard]] bool operator==(const GeometricComb&) const = default;
};
static_assert(ToneWaveform<GeometricComb>);

}  // namespace asdic::detail
