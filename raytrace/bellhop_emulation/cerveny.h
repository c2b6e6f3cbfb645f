#pragma once
#include <complex>

#include "raytrace/bellhop_emulation/beam.h"

namespace asdic::detail::bellhop_emulation {

/// ε of a Červený beam: q = q₁ + ε·q₂, p = p₁ + ε·p₂.
///   space filling  iωh²/2, h = 2c/(ω·dα)     minimum  iωh²/2, h² = 2c·R/ω (narrowest at range R)
///   WKB  −c²·sin α/(cos²α·c_z), real: a front that is plane in every layer
[[nodiscard]] std::complex<double> beam_epsilon(const Beam& beam,
                                                const CervenyBeams& kind) noexcept;

/// Branch of √q along a ray: ±1, changing when q crosses the negative real axis.
[[nodiscard]] inline double next_branch(double branch, std::complex<double> from,
                                        std::complex<double> to) noexcept {
  const bool crossed =
      (from.imag() < 0.0 && to.imag() >= 0.0) || (from.imag() > 0.0 && to.imag() <= 0.0);
  return to.real() < 0.0 && crossed ? -branch : branch;
}

/// 1 up to 50 wavelengths off the ray, 0 beyond 100, a cubic between.
[[nodiscard]] double taper(double distance, double wavelength) noexcept;

/// What the pressure of a beam is multiplied with: 1, or the sine or cosine of its ray's angle, for
/// a velocity times ρc; a vertical one is upside down in image k. How BELLHOP weighs its V and H is
/// not known: these are asdic's own (docs/theory/beams.md). \param t  scaled tangent
[[nodiscard]] inline double component(const CervenyBeams& kind, const Vec2& t, int k) noexcept {
  if (kind.component == CervenyBeams::Component::pressure) return 1.0;
  const Vec2 e = t.normalized();
  if (kind.component == CervenyBeams::Component::horizontal) return e.x();
  return k == 0 ? e.y() : -e.y();
}

/// The receiver at `depth` as image k sees it (0: itself, 1: over the surface, 2: under the
/// bottom), and the sign of its reflection: the surface is taken as pressure release, the bottom as
/// rigid.
struct Image {
  double depth, sign;
};
[[nodiscard]] Image image_of(const Beam& beam, double depth, int k) noexcept;

}  // namespace asdic::detail::bellhop_emulation
