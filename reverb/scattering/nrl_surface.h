#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// Sea-surface scattering of the Naval Research Laboratory: rough interface plus subsurface
/// bubbles, bistatic, incoherent part only.
///
///   σ     = σ_int + σ_bub,  k = 2πf/c
///   σ_int = |β/2|²·W(Q) = 4k⁴ sin²θᵢ sin²θₛ · A_s·U/(h₀Q)^γ₂, at most 1
///   Q²    = k²[cos²θᵢ + cos²θₛ − 2 cos θᵢ cos θₛ cos φ]   (φ change of direction, π backscatter)
///   σ_bub = 0.0019·d^1.15·k^−0.6·F(kd sin θᵢ, kd sin θₛ)   (0.0019 carries m^−1.75: SI only)
///
/// Gauss, Fialkowski & Wurmser, NRL/FR/7100--02-10,042 (2002) as quoted by Danesh (2013),
/// eqs 4.3–4.12, with his 4.4 corrected (|β/2|², not |β²/2|). A_s, γ₂ and h₀ were never published
/// as numbers; the defaults reproduce the simulated columns of his Tables 5.3 and 5.4. Bubble term:
/// to 5 kHz, with a transition to 10 kHz; forward and near-specular values are not to be trusted.
/// docs/theory/surface-scattering.md.
struct NrlSurface {
  static constexpr std::string_view name = "nrl";
  double A_s = 5.5e-4;          ///< spectral strength per wind speed, w₂ = A_s·U [m⁴/(m/s)]
  double gamma2 = 3.9;          ///< exponent of the roughness spectrum
  double h0 = 1.0;              ///< its reference length [m]
  double wind_speed = 10.0;     ///< U at 10 m [m/s]
  double sound_speed = 1500.0;  ///< at the surface [m/s]

  void describe(Fields& field) {
    field("A_s", A_s, {.noun = "strength", .unit = "m4/(m/s)", .low = 0.0, .high = 1.0},
          "spectral strength of the roughness per wind speed");
    field("gamma2", gamma2, {.noun = "exponent", .low = 2.0, .high = 6.0},
          "of the roughness spectrum");
    field("h0", h0, {.noun = "length", .unit = "m", .low = 1e-3, .high = 1e3},
          "reference length of the roughness spectrum");
    field.derived(wind_speed);
    field.derived(sound_speed);
  }

  [[nodiscard]] static const Validity& validity() noexcept {
    static constexpr ValidRange ranges[] = {{"frequency", "Hz", 0.0, 5000.0}};
    static constexpr Validity validity{"the NRL law", "NRL/FR/7100--02-10,042, 2002", ranges};
    return validity;
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    return at(frequency)(sines_of(g));
  }
  [[nodiscard]] double interface_cross_section(const ScatterGeometry& g,
                                               double frequency) const noexcept {
    return at(frequency).interface(sines_of(g));
  }
  [[nodiscard]] double bubble_cross_section(const ScatterGeometry& g,
                                            double frequency) const noexcept {
    return at(frequency).bubbles(sines_of(g));
  }

  /// F(p, q) = ½{1 − 1/(1+p²) − 1/(1+q²) + ½[1/(1+(p−q)²) + 1/(1+(p+q)²)]}, written over one
  /// denominator because the sum of fractions cancels at small p, q.
  [[nodiscard]] static double bubble_directivity(double p, double q) noexcept {
    const double p2 = p * p, q2 = q * q;
    const double minus = (p - q) * (p - q), plus = (p + q) * (p + q);
    const double numerator = 0.5 * p2 * q2 * (6.0 + 3.0 * (p2 + q2) + (p2 - q2) * (p2 - q2));
    const double denominator = (1.0 + p2) * (1.0 + q2) * (1.0 + minus) * (1.0 + plus);
    return numerator / denominator;
  }

  /// The law at one frequency, for many directions.
  class At {
   public:
    At(const NrlSurface& law, double frequency) noexcept
        : k_(2.0 * pi * frequency / law.sound_speed),
          w2_(law.A_s * law.wind_speed),
          half_gamma_(0.5 * law.gamma2),
          h0_(law.h0) {
      const double d = bubble_depth(law.wind_speed);
      kd_ = k_ * d;
      if (k_ > 0.0 && d > 0.0) bubbles_ = 0.0019 * std::pow(d, 1.15) * std::pow(k_, -0.6);
    }
    [[nodiscard]] double operator()(const ScatterSines& g) const noexcept {
      return interface(g) + bubbles(g);
    }
    [[nodiscard]] double interface(const ScatterSines& g) const noexcept {  ///< σ_int
      if (k_ <= 0.0 || w2_ <= 0.0 || g.sin_in <= 0.0 || g.sin_out <= 0.0) return 0.0;
      const double q2 = k_ * k_ * g.across2();  // Q²
      if (q2 <= 0.0) return 1.0;  // vertical or specular: W(0) is infinite, the cap takes over
      const double half_beta = 2.0 * k_ * k_ * g.sin_in * g.sin_out;  // |β/2|
      const double fall = std::pow(h0_ * h0_ * q2, half_gamma_);  // (h₀Q)^γ₂: W(Q) = w₂/fall
      return std::min(1.0, half_beta * half_beta * w2_ / fall);
    }
    [[nodiscard]] double bubbles(const ScatterSines& g) const noexcept {  ///< σ_bub
      return bubbles_ * bubble_directivity(kd_ * g.sin_in, kd_ * g.sin_out);
    }

   private:
    double k_, w2_, half_gamma_, h0_, kd_ = 0.0;
    double bubbles_ = 0.0;  // 0.0019·d^1.15·k^−0.6
  };
  [[nodiscard]] At at(double frequency) const noexcept { return {*this, frequency}; }

  /// e-folding depth of the bubble layer against wind speed [m]; Danesh (2013), Table 4.2.
  [[nodiscard]] static double bubble_depth(double wind) noexcept {
    if (wind <= 3.0) return 0.0;
    if (wind <= 7.5) return -0.19509 + 0.06503 * wind;
    return 0.557 - 0.117 * wind + 0.0109 * wind * wind;
  }
};
static_assert(SurfaceScatteringModel<NrlSurface>);

}  // namespace asdic::detail
