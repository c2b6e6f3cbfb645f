#pragma once
#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/propagation_memory.h"
#include "sonar/scenario/noise_settings.h"

namespace asdic::detail {

/// Coherence of the noise at phone i with that at phone j, E[P_i P_j*]/E|P|² (time dependence
/// e^{+iωt}), of a field that is alike at all bearings:
///
///   Γ_ij = ∫ w(μ) J₀(k h √(1 − μ²)) e^{−ikμ(z_i − z_j)} dμ,   μ = sin ε, ∫w dμ = 1
///
/// ε the elevation that noise comes from, h the phones' horizontal distance. Isotropic:
/// sin(kd)/(kd) in closed form. Surface: w ∝ μ^{2m−1} above the horizon: 2ᵐm!J_m(kh)/(kh)ᵐ between
/// phones side by side (Cron & Sherman, JASA 34, 1732, 1962, with 38, 885, 1965).
/// docs/theory/noise.md. \param apart  x_i − x_j [m]   \param wavenumber  k [rad/m]
[[nodiscard]] std::complex<double> noise_coherence(NoiseCoherence kind,
                                                   const NoiseDirections& directions,
                                                   const Vec3& apart, double wavenumber);

/// The coherence of all pairs of an array's phones over frequency, in triangular factors: what
/// turns independent spectra into the phones', row i of L times them.
///
/// At node frequencies Γ + εI = (1 + ε)·L·Lᴴ exactly (Cholesky; ε = 1e-6, so that phones closer
/// than any wavelength do not stop it); between nodes L is interpolated straight. Nodes are halved
/// until half-way between them no element of L·Lᴴ is off by more than `tolerance`, or they are
/// neighbours.
class CoherenceFactors {
 public:
  static constexpr double tolerance = 2e-3;

  /// \param phones  [n] positions [m]   \param bins  frequencies at which factors will be asked for
  /// are first + i·step, i < bins [Hz]; those at or below 0 get the factor of 0
  CoherenceFactors(NoiseCoherence kind, const NoiseDirections& directions,
                   std::span<const Vec3> phones, double sound_speed, double first, double step,
                   std::size_t bins);

  /// The same out of a memory, if they were made of the same numbers before; null: made.
  [[nodiscard]] static std::shared_ptr<const CoherenceFactors> recalled(
      PropagationMemory* memory, NoiseCoherence kind, const NoiseDirections& directions,
      std::span<const Vec3> phones, double sound_speed, double first, double step,
      std::size_t bins);

  [[nodiscard]] std::size_t bytes() const noexcept;
  [[nodiscard]] std::size_t phones() const noexcept { return phones_; }
  [[nodiscard]] std::size_t nodes() const noexcept { return nodes_.size(); }
  [[nodiscard]] bool is_real() const noexcept { return real_; }  ///< all of every factor

  /// Element (row, column ≤ row) of the factor at the bins first … first + real.size() − 1.
  void element(std::size_t row, std::size_t column, std::size_t first, std::span<float> real,
               std::span<float> imaginary) const noexcept;

 private:
  std::size_t phones_;
  bool real_ = true;
  std::vector<std::size_t> nodes_;           // bins, increasing
  std::vector<std::complex<float>> factor_;  // [pairs × nodes], pair = row(row + 1)/2 + column
};

}  // namespace asdic::detail
