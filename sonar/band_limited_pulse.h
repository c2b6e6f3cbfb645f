#pragma once
#include <functional>

#include "core/units.h"
#include "sonar/pulse.h"
#include "sonar/sampled_signal.h"

namespace asdic {

/// The pulse as the phones' anti-alias filter lets it through, around its middle:
/// s₊(u + T/2) ≈ at(u)·e^{i2π f u}, f the centre frequency.
///
/// The filter is flat over a width so chosen that a pulse with soft edges loses less than −90 dB of
/// its peak. A pulse whose edges jump (no window) has no such width; it keeps four times its −40 dB
/// bandwidth, but no more than is recorded, and its edges rise in about 1/width. Source:
/// docs/theory/synthesis.md, "Band".
class BandLimitedPulse {
 public:
  /// \param filter  a further, real response over the frequency from the centre [Hz], smooth over
  /// the band; none: 1   \param recorded  width around the centre beyond which nothing is recorded
  /// [Hz]: a pulse whose edges jump is flat over no more than that
  BandLimitedPulse(const Pulse& pulse, double sample_rate,
                   const std::function<double(double)>& filter = {}, double recorded = infinity);

  [[nodiscard]] std::complex<double> at(double u) const noexcept { return signal_.at(u); }
  /// Nothing is heard further than this from the middle [s].
  [[nodiscard]] double half_duration() const noexcept { return half_duration_; }
  /// The spectrum is zero further than this from the centre frequency [Hz].
  [[nodiscard]] double half_band() const noexcept { return half_band_; }
  [[nodiscard]] double centre_frequency() const noexcept { return centre_frequency_; }

 private:
  SampledSignal signal_;
  double centre_frequency_ = 0.0, half_duration_ = 0.0, half_band_ = 0.0;
};

}  // namespace asdic
