#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/layered/layer.h"
#include "raytrace/layered/ray_parameter.h"
#include "raytrace/layered/speed_drop.h"
#include "raytrace/math/gauss_legendre.h"

namespace asdic::detail {

/// Speed and sin²θ of a ray along the way from one depth of a layer, where the water is fastest on
/// it: s² = s₀² + ξ²(c₀ − c)(c₀ + c), a sum of what is not negative, so that s² is as exact as s₀²
/// where the speed hardly differs from c₀.
class RayAlong {
 public:
  struct At {
    double c, sine2;
  };

  /// \param depth, sign  where the way begins, and whether it goes down (+1) or up (−1)
  /// \param speed, sine2  of water and ray there
  RayAlong(const Layer& layer, const RayParameter& ray, double depth, double sign, double speed,
           double sine2) noexcept
      : layer_(layer),
        ray_(ray),
        drop_(speed_drop(layer, depth, sign)),
        depth_(depth),
        sign_(sign),
        speed_(speed),
        sine2_(sine2),
        slowness2_(ray.slowness * ray.slowness) {}

  /// From the layer's faster edge, where the sine of a ray that crosses it is known.
  static RayAlong from_flat_edge(const Layer& layer, const RayParameter& ray, double sine_top,
                                 double sine_bottom) noexcept {
    return falls(layer) ? RayAlong(layer, ray, layer.top, 1.0, layer.c_top, sine_top * sine_top)
                        : RayAlong(layer, ray, layer.bottom, -1.0, layer.c_bottom,
                                   sine_bottom * sine_bottom);
  }
  /// From the depth where the ray turns.
  static RayAlong from_turn(const Layer& layer, const RayParameter& ray, double depth,
                            double sign) noexcept {
    return {layer, ray, depth, sign, ray.turning_speed(), 0.0};
  }

  [[nodiscard]] const Layer& layer() const noexcept { return layer_; }
  [[nodiscard]] double depth(double t) const noexcept { return depth_ + sign_ * t; }
  [[nodiscard]] double sine2_at_begin() const noexcept { return sine2_; }
  [[nodiscard]] double slowness2() const noexcept { return slowness2_; }

  /// At a distance t > 0 [m].
  [[nodiscard]] At at(double t) const noexcept {
    if (layer_.law == Layer::Law::cubic) return at_cubic(t);
    const double c = layer_.at(depth(t)).c;
    return {c, std::max(ray_.sine2(c), 1e-300)};
  }
  /// The same where the law is cubic: no branch, for loops that become vector instructions.
  [[nodiscard]] At at_cubic(double t) const noexcept {
    const double drop = drop_(t), sine2 = sine2_ + slowness2_ * drop * (2.0 * speed_ - drop);
    return {speed_ - drop, sine2 > 1e-300 ? sine2 : 1e-300};
  }

 private:
  const Layer& layer_;
  const RayParameter& ray_;
  SpeedDrop<double> drop_;
  double depth_, sign_, speed_, sine2_, slowness2_;
};

/// Calls f(c, 1/s, dz) at the n Gauss–Legendre nodes between two distances along a way through a
/// layer with a cubic law; the loop over nodes becomes vector instructions.
template <std::size_t n, class F>
void at_cubic_nodes(const RayAlong& way, double from, double to, F&& f) {
  using Rule = GaussLegendre<n>;
  const double centre = 0.5 * (from + to), half = 0.5 * (to - from);
  std::array<double, n> speed, per_sine;
  for (std::size_t i = 0; i < n; ++i) {
    const auto [c, sine2] = way.at_cubic(centre + half * Rule::node[i]);
    speed[i] = c;
    per_sine[i] = 1.0 / std::sqrt(sine2);
  }
  for (std::size_t i = 0; i < n; ++i) f(speed[i], per_sine[i], half * Rule::weight[i]);
}

/// Calls f(SoundSpeed, 1/s, dz) at 8 Gauss–Legendre nodes in u = √(t + before), t the distance
/// along a way through a layer, from 0 to `length`. `before` lies, against the way, a depth where
/// s² of the ray is zero or, carried on in a straight line, would be: there s is nearly
/// proportional to u, so that u/s is smooth however flat the ray is.
template <class F>
void at_nodes_in_root(const RayAlong& way, double before, double length, F&& f) {
  using Rule = GaussLegendre<8>;
  const double u_from = std::sqrt(before), u_to = std::sqrt(before + length);
  const double centre = 0.5 * (u_from + u_to), half = 0.5 * (u_to - u_from);
  const Layer& layer = way.layer();
  std::array<double, 8> t, c, slope, bend, per_sine, dz;
  for (std::size_t i = 0; i < 8; ++i) {
    const double u = centre + half * Rule::node[i];
    t[i] = u * u - before;
    dz[i] = 2.0 * u * half * Rule::weight[i];
  }
  if (layer.law == Layer::Law::cubic) {  // in a loop that becomes vector instructions
    const auto [a0, a1, a2, a3] = layer.coefficient;
    for (std::size_t i = 0; i < 8; ++i) {
      const double z = way.depth(t[i]) - layer.origin;
      const auto here = way.at_cubic(t[i]);
      c[i] = here.c;
      slope[i] = a1 + z * (2.0 * a2 + 3.0 * z * a3);
      bend[i] = 2.0 * a2 + 6.0 * z * a3;
      per_sine[i] = 1.0 / std::sqrt(here.sine2);
    }
  } else {
    for (std::size_t i = 0; i < 8; ++i) {
      const SoundSpeed water = layer.at(way.depth(t[i]));
      c[i] = water.c;
      slope[i] = water.dc_dz;
      bend[i] = water.d2c_dz2;
      per_sine[i] = 1.0 / std::sqrt(way.at(t[i]).sine2);
    }
  }
  for (std::size_t i = 0; i < 8; ++i) f(SoundSpeed{c[i], slope[i], bend[i]}, per_sine[i], dz[i]);
}

/// How far before a layer's flatter edge s² would be zero: that of the parabola s² = s₀² + A(x −
/// κx²), A = 2ξ²cg, κ = (g/c + c″/g)/2, x the way from the edge, g = |dc/dz| there. A straight
/// line's own, δ = s₀²/A, would leave κδ² of s²/A at a distance δ from the edge, which few nodes
/// cannot see.
template <class Real>
Real before_edge(const Real& sine2, const Real& slowness2, const SoundSpeed& edge) {
  using std::max, std::sqrt;
  const double g = std::abs(edge.dc_dz);
  const Real line = sine2 / (2.0 * edge.c * g * slowness2);
  const Real root2 = 1.0 + line * (2.0 * (g / edge.c + edge.d2c_dz2 / g));
  return 2.0 * line / (1.0 + sqrt(max(root2, Real(0.25))));
}

/// Over a layer whose dc/dz hardly varies, from the flatter edge's virtual vertex.
template <class F>
void integrate_evenly_bent(const RayAlong& from_flat_edge, F&& f) {
  const Layer& layer = from_flat_edge.layer();
  const SoundSpeed edge = layer.at(from_flat_edge.depth(0.0));
  const double before =
      before_edge(from_flat_edge.sine2_at_begin(), from_flat_edge.slowness2(), edge);
  at_nodes_in_root(from_flat_edge, before, layer.thickness(), f);
}

/// Integrals over a way through a layer whose law has no closed form: `direct(c, 1/s, dz)` is
/// called at depths where s = sin θ is well away from zero compared with the node spacing;
/// `near_turn(SoundSpeed, 1/s, dz)` on the piece that ends at a turning point, where nodes are
/// placed in u = √|z − z_turn| so that 1/s is smooth. The caller sums what it needs.
///
/// Away from a turning point the panels grow threefold from the edge where the ray is flattest, at
/// the distance `flat` along the way, to `steep`: an integrand like (δ + x)^(−3/2) is then resolved
/// to 1e-9 however small δ is.
template <class Direct>
void panels_from_flat_edge(const RayAlong& way, double flat, double steep, double scale,
                           Direct&& direct) {
  const double total = steep - flat;
  const auto panel = [&](double a, double b) {
    if (way.layer().law == Layer::Law::cubic)
      return at_cubic_nodes<8>(way, flat + a, flat + b, direct);
    gauss_legendre(flat + a, flat + b, [&](double t, double w) {
      const auto [c, sine2] = way.at(t);
      direct(c, 1.0 / std::sqrt(sine2), w);
    });
  };
  double from = 0.0, to = std::max(scale, 1e-12 * total);
  while (from < total) {
    if (1.5 * to > total) to = total;
    panel(from, to);
    from = to;
    to *= 3.0;
  }
}

/// How far from its flatter edge s² of a ray has doubled: s² ≈ s₀² + A·x + B·x² there, so x =
/// 2s₀²/(A + √(A² + 4Bs₀²)) [m].
[[nodiscard]] inline double doubling_distance(const RayAlong& from_flat_edge) {
  const double s2 = from_flat_edge.sine2_at_begin();
  const SoundSpeed edge = from_flat_edge.layer().at(from_flat_edge.depth(0.0));
  const double k = 2.0 * from_flat_edge.slowness2();
  const double a = k * edge.c * std::abs(edge.dc_dz);
  const double b = 0.5 * k * std::abs(edge.c * edge.d2c_dz2 + edge.dc_dz * edge.dc_dz);
  const double root = a + std::sqrt(a * a + 4.0 * b * s2);
  return root > 0.0 ? 2.0 * s2 / root : 1e300;
}

/// Over a layer that the ray crosses.
template <class Direct>
void integrate_crossing(const RayAlong& from_flat_edge, Direct&& direct) {
  const double total = from_flat_edge.layer().thickness();
  const double scale = std::min(doubling_distance(from_flat_edge), total);
  panels_from_flat_edge(from_flat_edge, 0.0, total, scale, direct);
}

/// Where the near piece of a turning ray ends.
struct HandOver {
  double depth;  ///< where `near_turn` hands over to `direct` [m]
  double sine2;  ///< of the ray there
};

/// From the slower edge of the layer to the turning depth in it.
template <class Direct, class NearTurn>
HandOver integrate_turning(const Layer& layer, const RayParameter& ray, double turn,
                           Direct&& direct, NearTurn&& near_turn) {
  const bool downward = layer.c_bottom > layer.c_top;  // the ray comes from the slower edge
  const double edge = downward ? layer.top : layer.bottom;
  const double sign = downward ? -1.0 : 1.0;  // from the turning depth towards the edge
  const double total = std::abs(edge - turn);
  const RayAlong way = RayAlong::from_turn(layer, ray, turn, sign);
  const SoundSpeed there = layer.at(turn);
  // The near piece stays where dc/dz keeps at least half its value, up to its far end.
  double near = total;
  if (std::abs(there.d2c_dz2) * near > 0.5 * std::abs(there.dc_dz))
    near = 0.5 * std::abs(there.dc_dz / there.d2c_dz2);
  while (std::abs(layer.at(turn + sign * near).dc_dz) < 0.5 * std::abs(there.dc_dz)) near *= 0.5;
  at_nodes_in_root(way, 0.0, near, near_turn);
  if (near < total) panels_from_flat_edge(way, near, total, near, direct);
  return {near < total ? way.depth(near) : edge, way.at(near).sine2};
}

}  // namespace asdic::detail
