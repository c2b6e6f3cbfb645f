#include "raytrace/bellhop_emulation/reflect.h"

#include <algorithm>
#include <cmath>

#include "raytrace/ocean/beam_displacement.h"

namespace asdic::detail::bellhop_emulation {
namespace {

using Complex = std::complex<double>;

constexpr double neper_db = 8.6858896;    // BELLHOP's 20·log₁₀e
constexpr double least_magnitude = 1e-5;  // of a half space's coefficient: less is nothing

struct Wave {
  double omega;      // [rad/s]
  double kx, kz;     // along and across the boundary [1/m]
  double rho;        // of the water [kg/m³]
  double frequency;  // [Hz]
};

/// BELLHOP's c + i·α·c²/ω = c·(1 + iδ), of the speed c·(1 + δ²) that has the same wave number.
Complex complex_speed(double speed, double db_per_wavelength) noexcept {
  const double delta = db_per_wavelength / (2.0 * pi * neper_db);
  return speed / Complex(1.0, -delta);
}

/// √(k_x² − (ω/c)²), decaying away from the boundary.
Complex vertical(double kx, double omega, Complex c) noexcept {
  const Complex square = kx * kx - (omega / c) * (omega / c);
  const Complex root = std::sqrt(square);
  return root.real() == 0.0 && root.imag() < 0.0 ? -root : root;
}

/// R = −(ρ_w f − i k_z g)/(ρ_w f + i k_z g).
Complex from_impedance(Complex f, Complex g, const Wave& k) noexcept {
  const Complex i_kz_g = Complex(0.0, k.kz) * g;
  return -(k.rho * f - i_kz_g) / (k.rho * f + i_kz_g);
}

Complex half_space(const FluidHalfSpace& m, const Wave& k) noexcept {
  const Complex c = complex_speed(m.speed, m.attenuation_db_per_wavelength);
  return from_impedance(vertical(k.kx, k.omega, c), m.density, k);
}

Complex half_space(const ElasticHalfSpace& m, const Wave& k) noexcept {
  const Complex c_p = complex_speed(m.speed, m.attenuation_db_per_wavelength);
  const Complex c_s = complex_speed(m.shear_speed, m.shear_attenuation_db_per_wavelength);
  const Complex g_p = vertical(k.kx, k.omega, c_p), g_s = vertical(k.kx, k.omega, c_s);
  const double kx2 = k.kx * k.kx;
  const Complex mu = m.density * c_s * c_s, g_s2 = g_s * g_s;
  const Complex sum = g_s2 + kx2;
  const Complex f = k.omega * k.omega * g_p * (kx2 - g_s2);
  const Complex g = mu * (sum * sum - 4.0 * g_s * g_p * kx2);
  return from_impedance(f, g, k);
}

/// Magnitude and phase, linear between rows, nothing outside the table.
void from_table(const ReflectionTable& table, double grazing, LiteralPoint& y) noexcept {
  const auto& a = table.grazing;
  if (a.empty() || grazing < a.front() || grazing > a.back()) {
    y.amplitude = 0.0;
    return;
  }
  std::size_t i =
      static_cast<std::size_t>(std::upper_bound(a.begin(), a.end(), grazing) - a.begin());
  i = std::clamp<std::size_t>(i, 1, std::max<std::size_t>(a.size(), 2) - 1);
  if (a.size() == 1) {
    y.amplitude *= table.magnitude[0];
    y.phase += table.phase[0];
    return;
  }
  const double w = (grazing - a[i - 1]) / (a[i] - a[i - 1]);
  y.amplitude *= table.magnitude[i - 1] + w * (table.magnitude[i] - table.magnitude[i - 1]);
  y.phase += table.phase[i - 1] + w * (table.phase[i] - table.phase[i - 1]);
}

struct ApplyMaterial {
  const Wave& k;
  LiteralPoint& y;

  void operator()(const Vacuum&) const noexcept { y.phase += pi; }
  void operator()(const Rigid&) const noexcept {}
  void operator()(const ReflectionTable& table) const noexcept {
    double grazing = std::abs(std::atan2(k.kz, k.kx));
    if (grazing > 0.5 * pi) grazing = pi - grazing;
    from_table(table, grazing, y);
  }
  void operator()(const ReflectionCurves& curves) const noexcept { as_ours(curves); }
  void operator()(const LayeredFloor& floor) const noexcept { as_ours(floor); }
  void operator()(const auto& solid) const noexcept { apply(half_space(solid, k)); }

 private:
  /// BELLHOP knows no such material: the coefficient is asdic's.
  void as_ours(const BoundaryMaterial& material) const noexcept {
    const double steep = std::abs(k.kz), level = std::abs(k.kx);
    apply(reflection_coefficient(
        material, std::atan2(steep, level),
        {.speed = k.omega / std::hypot(steep, level), .density = k.rho, .frequency = k.frequency}));
  }
  void apply(const Complex& r) const noexcept {
    if (std::abs(r) < least_magnitude) {
      y.amplitude = 0.0;
      return;
    }
    y.amplitude *= std::abs(r);
    y.phase += std::arg(r);
  }
};

/// Carries a reflected beam along its facet, a straight line here: the point, the delay and both
/// solutions p, q, by asdic's own formulas (docs/theory/reflections.md (1)-(3)): no output of
/// BELLHOP's option S is at hand.
void displace(const LiteralOcean& ocean, const LiteralPoint& in, const WaterPoint& w,
              const Vec2& tangent, const BoundaryMaterial& material, LiteralPoint& y) noexcept {
  const Vec2 t_in = w.c * in.t, t_out = w.c * y.t;
  const double cosine = tangent.dot(t_in);
  const double sine = tangent.y() * t_in.x() - tangent.x() * t_in.y();
  if (sine == 0.0) return;
  const BeamDisplacement moved = beam_displacement(
      material, std::abs(std::atan2(sine, std::abs(cosine))),
      {.speed = w.c, .density = ocean.water.density(in.x.y()), .frequency = ocean.frequency},
      ocean.frequency);
  const auto bend = [&](const Vec2& t) { return -w.gradient().dot(Vec2(-t.y(), t.x())) / w.c; };
  const auto carry = [&](double q_in, double p_in, double& q, double& p) {
    const double turn = -(w.c * p_in + bend(t_in) * q_in / sine * cosine);
    const double spread = std::copysign(1.0, sine) * moved.per_grazing * turn;
    q += sine * spread;
    p += bend(t_out) * spread * cosine / w.c;
    return q / sine * -sine * turn < 0.0;  // dl/dk_t afterwards
  };
  const bool falling = carry(in.q1, in.p1, y.q1, y.p1);
  // beams count every sign change of q as +pi/2; one where dl/dk_t falls through zero is -pi/2
  if (in.q1 * y.q1 < 0.0 && falling) y.phase -= pi;
  carry(in.q2, in.p2, y.q2, y.p2);
  const double way = std::copysign(1.0, cosine) * moved.length;
  y.x += way * tangent;
  y.tau += way * cosine / w.c;
}

}  // namespace

LiteralPoint reflect(const LiteralOcean& ocean, const LiteralPoint& in, BoundaryKind kind,
                     RayPlace& place, CervenyBeams::Curvature curvature) noexcept {
  const bool at_bottom = kind == BoundaryKind::bottom;
  const BoundaryLine& line = at_bottom ? ocean.bottom : ocean.surface;
  const std::size_t segment = at_bottom ? place.bottom : place.surface;
  const BoundaryLine::Facet facet = line.facet(in.x, segment);
  const double tg = in.t.dot(facet.tangent), th = in.t.dot(facet.normal);

  LiteralPoint y = in;
  y.t = in.t - 2.0 * th * facet.normal;

  ocean.water.locate(in.x, in.t, place.cell);
  const WaterPoint w = ocean.water.at(in.x, place.cell);
  y.c = w.c;
  y.gradient = w.gradient();
  // The normal of the reflected ray is the mirror image of the incident one's.
  const Vec2 tangent_in = w.c * in.t, tangent_out = w.c * y.t;
  const Vec2 normal_in(-tangent_in.y(), tangent_in.x()),
      normal_out(tangent_out.y(), -tangent_out.x());
  double cn = -w.gradient().dot(normal_out - normal_in);
  const double cs = -w.gradient().dot(tangent_out - tangent_in);
  double rn = 2.0 * facet.curvature / (w.c * w.c * th);
  if (!at_bottom) {
    cn = -cn;
    rn = -rn;
  }
  const double rm = tg / th;
  rn += rm * (2.0 * cn - rm * cs) / (w.c * w.c);
  if (curvature == CervenyBeams::Curvature::doubled) rn *= 2.0;
  if (curvature == CervenyBeams::Curvature::zero) rn = 0.0;
  y.p1 += y.q1 * rn;
  y.p2 += y.q2 * rn;

  const double omega = 2.0 * pi * ocean.frequency;
  const Wave k{.omega = omega,
               .kx = omega * tg,
               .kz = omega * th,
               .rho = ocean.water.density(in.x.y()),
               .frequency = ocean.frequency};
  std::visit(ApplyMaterial{k, y}, line.material(segment));
  if (ocean.displacement) displace(ocean, in, w, facet.tangent, line.material(segment), y);
  (at_bottom ? y.bottom_bounces : y.surface_bounces) += 1;
  return y;
}

}  // namespace asdic::detail::bellhop_emulation
