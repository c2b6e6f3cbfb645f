#pragma once
#include <complex>
#include <span>
#include <vector>

#include "sonar/signal/sampled_signal.h"

namespace asdic::detail {

/// The transmitted pulse as the receiver knows it: stored samples, made analytic, at any Doppler
/// factor.
///
/// Kept as its spectrum, which is smooth (the pulse is short) and so can be had at any frequency by
/// band-limited interpolation: s₊(ηt) has the spectrum S(f/η)/η, exactly.
/// Source: docs/theory/processing.md, eq. (2)
class Replica {
 public:
  /// \param samples  Re s₊ from its leading edge on, as a ping file stores it
  /// \throws InputError ("replica") for fewer than two samples or silence
  Replica(std::span<const float> samples, double sample_rate);
  /// \param envelope  s₊(t)·e^{−i2π·carrier·t}
  Replica(std::span<const std::complex<float>> envelope, double sample_rate, double carrier);

  /// ∫ s₊(ηt)·e^{−i2πft} dt [s]
  [[nodiscard]] std::complex<double> spectrum(double frequency,
                                              double doppler = 1.0) const noexcept;

  [[nodiscard]] double duration() const noexcept { return duration_; }  ///< of the samples [s]
  [[nodiscard]] double energy() const noexcept { return energy_; }      ///< ∫|s₊|²dt [s]
  /// Mean frequency, weighted by energy [Hz].
  [[nodiscard]] double centre_frequency() const noexcept { return centre_; }
  /// Lowest and highest frequency [Hz] outside which the spectrum stays 40 dB below its peak.
  [[nodiscard]] double lowest_frequency() const noexcept { return lowest_; }
  [[nodiscard]] double highest_frequency() const noexcept { return highest_; }
  [[nodiscard]] double bandwidth() const noexcept { return highest_ - lowest_; }
  /// Effective (noise) bandwidth (∫|S|²df)²/∫|S|⁴df [Hz]: a filter matched to the pulse answers
  /// noise with one independent value every 1/bandwidth.
  [[nodiscard]] double noise_bandwidth() const noexcept { return noise_bandwidth_; }

 private:
  /// \param bins  ∫s₊e^{−i2πft}dt at first + k·spacing
  void measure(std::vector<std::complex<double>> bins, double first, double spacing);

  SampledSignal spectrum_;  // of s₊(t + duration/2), over frequency
  double duration_ = 0.0, energy_ = 0.0, centre_ = 0.0, lowest_ = 0.0, highest_ = 0.0,
         noise_bandwidth_ = 0.0;
};

}  // namespace asdic::detail
