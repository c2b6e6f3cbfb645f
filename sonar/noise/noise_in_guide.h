#pragma once
#include "sonar/scenario/noise_settings.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Power per solid angle of a sheet of sources just under the surface of a stratified ocean,
/// received at a depth, over elevation ε (positive: from above):
///
///   w(ε) = sin^{2m−1}θ_s·a/(1 − |R_s|²|R_b|²a²b²),    w(−ε) = w(ε)·|R_b|²b²
///
/// θ_s, θ_b the grazing angles at surface and bottom by Snell's law; a and b the shares of power
/// that absorption leaves between phone and surface and between phone and bottom or the ray's turn;
/// nothing where the ray does not reach the surface. It is what the count of bounces gives, Σ
/// |R_s R_b|²ⁿ(ab)²ⁿ, and the mean over the resonances of Kuperman & Ingenito's integral (JASA 67,
/// 1988, 1980); after C. H. Harrison, JASA 99, 2055 (1996). docs/theory/noise.md
/// \param depth  of the phones [m]   \param dipole_exponent  m   \param frequency [Hz]
/// \return over elevations between which it is straight in dB to 0.1 dB
[[nodiscard]] NoiseDirections surface_noise(const Environment& ocean, double depth,
                                            double dipole_exponent, double frequency);

/// The most that a bottom sends up again of what falls on it, at any angle: a share, 0 … 1.
struct SentUp {
  double share = 0.0, angle = 0.0;  ///< at a grazing angle [rad]
};
[[nodiscard]] SentUp sent_up(const Environment& ocean, double frequency);

/// As the scenario asks for it at one of its arrays: a sheet under the surface over a level bottom
/// that sends up a thousandth or more is received in its guide, at the first pulse's centre.
[[nodiscard]] NoiseField noise_field(const Scenario& scenario, int array);

}  // namespace asdic::detail
