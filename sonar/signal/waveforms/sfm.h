#pragma once
#include <optional>
#include <string_view>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// A frequency that swings as a cosine, f(t) = f_c + ½W cos ψ(t), ψ = 2π∫f_m dt, f_m the
/// modulation: φ(t) = 2πf_c t + β sin(2πf_m t), β = W/(2f_m), has lines of J_n(β) at f_c + n f_m.
/// One modulation that sweeps to another has no lines, and side lobes of its ambiguity spread.
/// Collins & Atkins, IEE Proc. 145 (1998), and Hague & Buck, IEEE J. Ocean. Eng. 42, 109 (2017).
struct Sfm {
  static constexpr std::string_view name = "sfm", title = "SFM";
  double frequency = 4000.0;           ///< f_c [Hz]
  double swing = 200.0;                ///< W, from the lowest to the highest frequency [Hz]
  double modulation_frequency = 10.0;  ///< f_m [Hz]
  std::optional<double> end_modulation_frequency = {};  ///< where it sweeps linearly to [Hz]

  void describe(Fields& field);
  void check(Fields& field, double duration) const;
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {frequency - 0.5 * swing, frequency + 0.5 * swing};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const Sfm&) const = default;
};
static_assert(PhaseWaveform<Sfm>);

}  // namespace asdic::detail
