#pragma once
#include <vector>

namespace asdic::detail {

/// The share of the incident energy that a scattering law takes to other directions, by grazing
/// angle and wavenumber. docs/theory/surface-scattering.md, "Energy"
struct ScatteredElsewhere {
  std::vector<double> wavenumbers;  ///< [n] increasing [rad/m]; none: no law
  std::vector<double> share;        ///< [n × angles], at angles even from 0 to π/2
  std::size_t angles = 0;

  /// Straight between angles and between logarithms of k, level beyond these. \param grazing [rad]
  [[nodiscard]] double at(double grazing, double wavenumber) const noexcept;
  [[nodiscard]] bool operator==(const ScatteredElsewhere&) const = default;
};

/// How rough a boundary is, and what the bubbles under it take: what is left of a mirror's
/// reflection. docs/theory/boundaries.md, "Roughness"
struct Roughness {
  double rms_height = 0.0;   ///< h [m]; 0: smooth
  double sea_wind = 0.0;     ///< U at 10 m of the Pierson–Moskowitz sea that it is [m/s]; 0: no
                             ///< spectrum is known
  double bubble_wind = 0.0;  ///< U at 10 m over the bubbles below it [m/s]; 0: none
  double floor_db = -20.0;  ///< the least that a bounce leaves of the mean field, 20 lg [dB], ≤ 0
  ScatteredElsewhere elsewhere = {};  ///< by the scattering law of the boundary

  /// Whether a bounce is a mirror's.
  [[nodiscard]] bool smooth() const noexcept { return !(rms_height > 0.0 || bubble_wind > 0.0); }

  [[nodiscard]] bool operator==(const Roughness&) const = default;
};

/// What a bounce leaves, beside a mirror's reflection.
struct RoughReflection {
  double coherent = 1.0;  ///< factor on the pressure of the mean field, 0 … 1
  double energy = 1.0;  ///< factor on the energy that goes on along the path, coherent² … 1: the
                        ///< mean field and what is scattered about it
};

/// coherent² = e^{−p}·B, p by scattering_exponent(), B what bubbles leave; energy = max(e^{−p},
/// 1 − S)·B, S the share that the scattering law takes elsewhere: coherent, scattered forward and
/// elsewhere are what came in, less B, and the forward share gives way. \param sine  of the grazing
/// angle \param wavenumber  k in the water at the boundary [rad/m]
[[nodiscard]] RoughReflection rough_reflection(const Roughness& roughness, double sine,
                                               double wavenumber) noexcept;

/// The coherent factor alone.
[[nodiscard]] double coherent_reflection(const Roughness& roughness, double sine,
                                         double wavenumber) noexcept;

/// p of the coherent energy e^{−p}. Of Gaussian heights of which only h is known: G² = (2kh sin
/// θ)², Eckart's (JASA 25, 566, 1953). Of a Pierson–Moskowitz sea, up to G = 1, what first-order
/// perturbation scatters,
///
///   p₁ = 4k sin θ·∫ W(K)·Re √(k² − (k_h + K)²) d²K,
///
/// which is G² where all that is scattered leaves as steeply as it came, and more at low angles;
/// from G = 2 on G², smoothly between. p₁ depends on θ and kU²/g alone: tabulated once.
[[nodiscard]] double scattering_exponent(const Roughness& roughness, double sine,
                                         double wavenumber) noexcept;

/// Where the waves of a sea run.
enum class Sea {
  isotropic,     ///< everywhere alike: the mean over bearings of any sea
  long_crested,  ///< with and against the sound, as in a vertical plane
};

/// p₁ by quadrature, from which the table (of an isotropic sea) is made.
/// \param scaled_wavenumber  kU²/g, U at 19.5 m   \param shortest  waves counted have K ≤
/// shortest·k
[[nodiscard]] double first_order_exponent(double sine, double scaled_wavenumber,
                                          Sea sea = Sea::isotropic, double shortest = 2.0);

/// Extinction in the bubbles under a breaking sea, dB a bounce: 1.26·10⁻³ U^1.57 f^0.85/sin θ, f in
/// kHz, from 6 m/s on; below, that of 6 m/s times e^{1.2(U − 6)}. APL-UW High-Frequency Ocean
/// Environmental Acoustic Models Handbook, TR 9407 (1994), p. II-21. \param frequency [Hz]
[[nodiscard]] double bubble_loss_db(double wind_speed, double sine, double frequency) noexcept;

/// Standard deviation of the surface's height in a fully developed sea, Pierson & Moskowitz:
/// h = 0.0523·(1.026 U)²/g [m], 0.56 m at 10 m/s. \param wind_speed  at 10 m [m/s]
[[nodiscard]] double pierson_moskowitz_height(double wind_speed) noexcept;

}  // namespace asdic::detail
