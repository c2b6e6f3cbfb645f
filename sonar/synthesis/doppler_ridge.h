#pragma once
#include <cstddef>

#include "sonar/signal/band_limited_pulse.h"

namespace asdic::detail {

/// The delay that sounds most like a Doppler shift of a pulse: a sweep of f_c by the rate B/T that
/// is received with the factor η is, but for its ends, one that is received f_c·(T/B)·(η − 1)
/// earlier. Stretched pulses that are moved back by that differ little, and fewer of them span all.
/// docs/theory/synthesis.md, "The ridge of sweeps"
class DopplerRidge {
 public:
  /// \param pulse  longer-lived than this
  explicit DopplerRidge(const BandLimitedPulse& pulse);

  /// κ: the pulse of the factor η is like that of 1 received κ·(η − 1) later [s]. −f_c·T/B of a
  /// sweep by B upwards, 0 of a tone.
  [[nodiscard]] double slope() const noexcept { return slope_; }

  static constexpr std::size_t too_many = 25;
  /// How many Chebyshev nodes serve a span of factors with an error of −80 dB of the pulse, both
  /// r.m.s. over its duration and the span. \return `too_many` if it is as many or more, if pulses
  /// were to be moved by more than a sixteenth of themselves, or if there is no ridge: of a tone
  [[nodiscard]] std::size_t nodes_needed(double span) const;

 private:
  const BandLimitedPulse& pulse_;
  double slope_ = 0.0;
};

}  // namespace asdic::detail
