#pragma once
#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

namespace asdic::detail {

class Pulse;

/// How far a pulse and itself a little later are in phase: R(Δ) = ∫s(t + Δ)s*(t)dt / ∫|s|²dt of its
/// envelope about the centre frequency. R(0) = 1, and 0 from its duration on.
class PulseCoherence {
 public:
  /// Of a tone that never ends: 1 at all times.
  PulseCoherence() = default;
  explicit PulseCoherence(const Pulse& pulse);

  /// Linear between samples 16 times as dense as the band asks for: right to 0.005.
  [[nodiscard]] std::complex<double> operator()(double later) const noexcept;
  /// Beyond which it is zero [s].
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// What tells it from that of another pulse: a hash of its samples.
  [[nodiscard]] std::uint64_t fingerprint() const noexcept { return fingerprint_; }

 private:
  double duration_ = 1e300, step_ = 0.0;
  std::uint64_t fingerprint_ = 0;
  std::vector<std::complex<float>> samples_;  // from 0 on
};

/// That of a pulse, which each thread remembers for the last few: a millisecond to find.
[[nodiscard]] std::shared_ptr<const PulseCoherence> pulse_coherence(const Pulse& pulse);

}  // namespace asdic::detail
