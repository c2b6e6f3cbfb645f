#pragma once
#include <functional>
#include <span>
#include <utility>

#include "core/units.h"
#include "sonar/signal/pulse.h"
#include "sonar/signal/recording.h"
#include "sonar/signal/sampled_signal.h"

namespace asdic::detail {

/// The pulse as the phones' anti-alias filter lets it through, around its middle:
/// s₊(u + T/2) ≈ at(u)·e^{i2π f u}, f the centre frequency.
///
/// The filter is flat over a width so chosen that a pulse with soft edges loses less than −90 dB of
/// its peak. A pulse whose edges jump (no window) has no such width; it keeps four times its −40 dB
/// bandwidth, and its edges rise in about 1/width. Of no pulse is more let through than is
/// recorded: what is cut off there rings for 39 over the flat width at most. Source:
/// docs/theory/synthesis.md, "Band".
class BandLimitedPulse {
 public:
  /// \param filter  a further, real response over the frequency from the centre [Hz], smooth over
  /// the band; none: 1   \param recorded  full width around the centre that may be let through
  /// [Hz]; the filter is flat over 1/1.3 of it
  BandLimitedPulse(const Pulse& pulse, double sample_rate,
                   const std::function<double(double)>& filter = {}, double recorded = infinity);
  /// A sound that is band-limited already. \param signal  about its middle, at(u) below
  /// \param half_duration, half_band  beyond which there is nothing [s], [Hz]
  BandLimitedPulse(SampledSignal signal, double centre_frequency, double half_duration,
                   double half_band)
      : signal_(std::move(signal)),
        centre_frequency_(centre_frequency),
        half_duration_(half_duration),
        half_band_(half_band) {}

  [[nodiscard]] std::complex<double> at(double u) const noexcept { return signal_.at(u); }
  /// Real and imaginary parts at many times. \param u  [n]
  void at(std::span<const double> u, std::span<double> real,
          std::span<double> imaginary) const noexcept {
    signal_.at(u, real, imaginary);
  }
  /// Nothing is received further than this from the middle [s].
  [[nodiscard]] double half_duration() const noexcept { return half_duration_; }
  /// The spectrum is zero further than this from the centre frequency [Hz].
  [[nodiscard]] double half_band() const noexcept { return half_band_; }
  [[nodiscard]] double centre_frequency() const noexcept { return centre_frequency_; }

 private:
  SampledSignal signal_;
  double centre_frequency_ = 0.0, half_duration_ = 0.0, half_band_ = 0.0;
};

/// Half width about the centre frequency outside which lies a share of a pulse's energy [Hz].
[[nodiscard]] double half_band_of_energy(const BandLimitedPulse& pulse, double left_out);

/// The pulse through a filter, in the band that a recording holds under every Doppler factor.
/// \param max_doppler  largest |η − 1|   \param filter  as BandLimitedPulse takes it
[[nodiscard]] BandLimitedPulse recorded_pulse(const Pulse& sent, const Recording& record,
                                              double max_doppler,
                                              const std::function<double(double)>& filter = {});

}  // namespace asdic::detail
