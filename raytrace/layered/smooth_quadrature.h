#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/layered/gauss_legendre.h"
#include "raytrace/layered/layer.h"
#include "raytrace/layered/ray_parameter.h"

namespace asdic {

/// Calls f(c, 1/s, dz) at the n Gauss–Legendre nodes between two depths of a layer with a cubic
/// law; the loop over nodes becomes vector instructions.
template <std::size_t n, class F>
void at_cubic_nodes(const Layer& layer, const RayParameter& ray, double top, double bottom, F&& f) {
  using Rule = GaussLegendre<n>;
  const double centre = 0.5 * (top + bottom) - layer.origin, half = 0.5 * (bottom - top);
  const auto [a0, a1, a2, a3] = layer.coefficient;
  const double c_ref = ray.reference_speed, sigma2 = ray.sigma * ray.sigma,
               per_c2 = 1.0 / (c_ref * c_ref);
  std::array<double, n> speed, per_sine;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = centre + half * Rule::node[i];
    const double c = a0 + t * (a1 + t * (a2 + t * a3));
    speed[i] = c;
    per_sine[i] = 1.0 / std::sqrt(((c_ref - c) * (c_ref + c) + sigma2 * c * c) * per_c2);
  }
  for (std::size_t i = 0; i < n; ++i) f(speed[i], per_sine[i], half * Rule::weight[i]);
}

/// Calls f(SoundSpeed, 1/s, dz) at 8 Gauss–Legendre nodes in u = √|z − vertex| between two
/// distances from a vertex, a depth where s² of the ray is zero or, carried on in a straight line,
/// would be: there s is nearly proportional to u, so that u/s is smooth however flat the ray is.
template <class F>
void at_nodes_in_root(const Layer& layer, const RayParameter& ray, double vertex, double sign,
                      double from, double to, F&& f) {
  using Rule = GaussLegendre<8>;
  const double u_from = std::sqrt(from), u_to = std::sqrt(to);
  const double centre = 0.5 * (u_from + u_to), half = 0.5 * (u_to - u_from);
  std::array<double, 8> c, slope, bend, per_sine, dz;
  if (layer.law == Layer::Law::cubic) {  // in a loop that becomes vector instructions
    const auto [a0, a1, a2, a3] = layer.coefficient;
    const double origin = vertex - layer.origin;
    for (std::size_t i = 0; i < 8; ++i) {
      const double u = centre + half * Rule::node[i];
      const double t = origin + sign * u * u;
      c[i] = a0 + t * (a1 + t * (a2 + t * a3));
      slope[i] = a1 + t * (2.0 * a2 + 3.0 * t * a3);
      bend[i] = 2.0 * a2 + 6.0 * t * a3;
    }
  } else {
    for (std::size_t i = 0; i < 8; ++i) {
      const double u = centre + half * Rule::node[i];
      const SoundSpeed water = layer.at(vertex + sign * u * u);
      c[i] = water.c;
      slope[i] = water.dc_dz;
      bend[i] = water.d2c_dz2;
    }
  }
  const double c_ref = ray.reference_speed, sigma2 = ray.sigma * ray.sigma,
               per_c2 = 1.0 / (c_ref * c_ref);
  for (std::size_t i = 0; i < 8; ++i) {
    const double s2 = ((c_ref - c[i]) * (c_ref + c[i]) + sigma2 * c[i] * c[i]) * per_c2;
    per_sine[i] = 1.0 / std::sqrt(s2 > 1e-300 ? s2 : 1e-300);
    dz[i] = 2.0 * (centre + half * Rule::node[i]) * half * Rule::weight[i];
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
void integrate_evenly_bent(const Layer& layer, const RayParameter& ray, double sine_top,
                           double sine_bottom, F&& f) {
  const bool flat_at_top = sine_top < sine_bottom;
  const double flat = flat_at_top ? layer.top : layer.bottom, sign = flat_at_top ? 1.0 : -1.0;
  const double s2 = flat_at_top ? sine_top * sine_top : sine_bottom * sine_bottom;
  const SoundSpeed edge = layer.at(flat);
  const double before = before_edge(s2, ray.slowness * ray.slowness, edge);
  at_nodes_in_root(layer, ray, flat - sign * before, sign, before, before + layer.thickness(), f);
}

/// Integrals over a way through a layer whose law has no closed form: `direct(c, 1/s, dz)` is
/// called at depths where s = sin θ is well away from zero compared with the node spacing;
/// `near_turn(SoundSpeed, 1/s, dz)` on the piece that ends at a turning point, where nodes are
/// placed in u = √|z − z_turn| so that 1/s is smooth. The caller sums what it needs.
///
/// Away from a turning point the panels grow threefold from the edge where the ray is flattest: an
/// integrand like (δ + x)^(−3/2) is then resolved to 1e-9 however small δ is.
template <class Direct>
void panels_from_flat_edge(const Layer& layer, const RayParameter& ray, double flat, double steep,
                           double scale, Direct&& direct) {
  const double sign = steep > flat ? 1.0 : -1.0, total = std::abs(steep - flat);
  const auto panel = [&](double a, double b) {
    if (layer.law == Layer::Law::cubic) {
      const double z_a = flat + sign * a, z_b = flat + sign * b;
      return at_cubic_nodes<8>(layer, ray, std::min(z_a, z_b), std::max(z_a, z_b), direct);
    }
    gauss_legendre(a, b, [&](double x, double w) {
      const double c = layer.at(flat + sign * x).c;
      direct(c, 1.0 / std::sqrt(std::max(ray.sine2(c), 1e-300)), w);
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
[[nodiscard]] inline double doubling_distance(const Layer& layer, const RayParameter& ray,
                                              double flat_edge, double s2) {
  const SoundSpeed edge = layer.at(flat_edge);
  const double k = 2.0 * ray.slowness * ray.slowness;
  const double a = k * edge.c * std::abs(edge.dc_dz);
  const double b = 0.5 * k * std::abs(edge.c * edge.d2c_dz2 + edge.dc_dz * edge.dc_dz);
  const double root = a + std::sqrt(a * a + 4.0 * b * s2);
  return root > 0.0 ? 2.0 * s2 / root : 1e300;
}

/// Over a layer that the ray crosses.
template <class Direct>
void integrate_crossing(const Layer& layer, const RayParameter& ray, double sine_top,
                        double sine_bottom, Direct&& direct) {
  const bool flat_at_top = sine_top < sine_bottom;
  const double flat = flat_at_top ? layer.top : layer.bottom,
               steep = flat_at_top ? layer.bottom : layer.top;
  const double s2 = flat_at_top ? sine_top * sine_top : sine_bottom * sine_bottom;
  const double scale = std::min(doubling_distance(layer, ray, flat, s2), layer.thickness());
  panels_from_flat_edge(layer, ray, flat, steep, scale, direct);
}

/// From the slower edge of the layer to the turning depth in it. \return the depth where the near
/// piece ends (where `near_turn` hands over to `direct`)
template <class Direct, class NearTurn>
double integrate_turning(const Layer& layer, const RayParameter& ray, double turn, Direct&& direct,
                         NearTurn&& near_turn) {
  const bool downward = layer.c_bottom > layer.c_top;  // the ray comes from the slower edge
  const double edge = downward ? layer.top : layer.bottom;
  const double sign = downward ? -1.0 : 1.0;  // from the turning depth towards the edge
  const double total = std::abs(edge - turn);
  const SoundSpeed there = layer.at(turn);
  // The near piece stays where dc/dz keeps at least half its value, up to its far end.
  double near = total;
  if (std::abs(there.d2c_dz2) * near > 0.5 * std::abs(there.dc_dz))
    near = 0.5 * std::abs(there.dc_dz / there.d2c_dz2);
  while (std::abs(layer.at(turn + sign * near).dc_dz) < 0.5 * std::abs(there.dc_dz)) near *= 0.5;
  at_nodes_in_root(layer, ray, turn, sign, 0.0, near, near_turn);
  const double hand_over = turn + sign * near;
  if (near < total) panels_from_flat_edge(layer, ray, hand_over, edge, near, direct);
  return hand_over;
}

}  // namespace asdic
