#pragma once
#include <complex>
#include <cstdint>
#include <vector>

namespace asdic::detail {

/// How far what is sent and itself a little later are in phase: R(Δ) = ∫s(t + Δ)s*(t)dt / ∫|s|²dt
/// of its envelope about the centre frequency. R(0) = 1, and 0 from its duration on.
class PulseCoherence {
 public:
  /// Of a tone that never ends: 1 at all times.
  PulseCoherence() = default;
  /// \param duration  [s]   \param step  between samples [s]   \param samples  R at 0, step, …, one
  /// beyond the duration at least; linear between them
  PulseCoherence(double duration, double step, std::vector<std::complex<float>> samples);

  [[nodiscard]] std::complex<double> operator()(double later) const noexcept;
  /// Beyond which it is zero [s].
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// Time beyond which it stays below 0.01 [s].
  [[nodiscard]] double lasting() const noexcept { return lasting_; }
  /// What tells it from that of another pulse: a hash of its samples.
  [[nodiscard]] std::uint64_t fingerprint() const noexcept { return fingerprint_; }

 private:
  double duration_ = 1e300, lasting_ = 1e300, step_ = 0.0;
  std::uint64_t fingerprint_ = 0;
  std::vector<std::complex<float>> samples_;  // from 0 on
};

}  // namespace asdic::detail
