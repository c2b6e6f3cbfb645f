#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/layered/layer.h"
#include "raytrace/layered/ray_parameter.h"

namespace asdic {

/// Positive Gauss–Legendre nodes on (−1, 1) and their weights, n even. Abramowitz & Stegun (1964),
/// table 25.4.
template <int n>
struct GaussLegendre;
template <>
struct GaussLegendre<4> {
  static constexpr std::array node = {0.3399810435848563, 0.8611363115940526};
  static constexpr std::array weight = {0.6521451548625461, 0.3478548451374538};
};
template <>
struct GaussLegendre<6> {
  static constexpr std::array node = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  static constexpr std::array weight = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
};
template <>
struct GaussLegendre<10> {
  static constexpr std::array node = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                      0.8650633666889845, 0.9739065285171717};
  static constexpr std::array weight = {0.2955242247147529, 0.2692667193099963, 0.2190863625159821,
                                        0.1494513491505806, 0.0666713443086881};
};

/// ∫ f over (a, b): f(x, weight) is called at each of the n nodes; exact for polynomials to degree
/// 2n − 1.
template <int n = 10, class F>
void gauss_legendre(double a, double b, F&& f) {
  const double centre = 0.5 * (a + b), half = 0.5 * (b - a);
  for (std::size_t i = 0; i < GaussLegendre<n>::node.size(); ++i) {
    const double dx = half * GaussLegendre<n>::node[i], w = half * GaussLegendre<n>::weight[i];
    f(centre - dx, w);
    f(centre + dx, w);
  }
}

/// Integrals over a way through a layer whose law has no closed form: `direct(c, s, dz)` is called
/// at depths where s = sin θ is well away from zero compared with the node spacing;
/// `near_turn(SoundSpeed, s, dz)` on the piece that ends at a turning point, where nodes are placed
/// in u = √|z − z_turn| so that 1/s is smooth. The caller sums what it needs.
///
/// Away from a turning point the panels grow fourfold from the edge where the ray is flattest: an
/// integrand like (δ + x)^(−3/2) is then resolved to 1e-10 however small δ is.
template <class Direct>
void panels_from_flat_edge(const Layer& layer, const RayParameter& ray, double flat, double steep,
                           double scale, Direct&& direct) {
  const double sign = steep > flat ? 1.0 : -1.0, total = std::abs(steep - flat);
  const auto at = [&](double x, double w) {
    const double c = layer.at(flat + sign * x).c;
    direct(c, std::sqrt(std::max(ray.sine2(c), 1e-300)), w);
  };
  // Bernstein: on (0, h) the error of n nodes for a singularity at −scale falls as ρ^(−2n), ρ = x +
  // √(x² − 1), x = 1 + 2·scale/h.
  if (layer.law == Layer::Law::cubic && scale > 16.0 * total)
    return gauss_legendre<4>(0.0, total, at);  // ρ ≈ 66
  if (layer.law == Layer::Law::cubic && scale > 2.0 * total)
    return gauss_legendre<6>(0.0, total, at);  // ρ ≈ 10
  double from = 0.0, to = std::max(scale, 1e-12 * total);
  while (from < total) {
    if (to > 0.5 * total) to = total;
    gauss_legendre(from, to, at);
    from = to;
    to *= 4.0;
  }
}

/// Over a layer that the ray crosses.
template <class Direct>
void integrate_crossing(const Layer& layer, const RayParameter& ray, double sine_top,
                        double sine_bottom, Direct&& direct) {
  const bool flat_at_top = sine_top < sine_bottom;
  const double flat = flat_at_top ? layer.top : layer.bottom,
               steep = flat_at_top ? layer.bottom : layer.top;
  const double s2 = flat_at_top ? sine_top * sine_top : sine_bottom * sine_bottom;
  // s² ≈ s₀² + A·x + B·x² near the flat edge: it has doubled after x = 2s₀²/(A + √(A² + 4Bs₀²)).
  const SoundSpeed edge = layer.at(flat);
  const double k = 2.0 * ray.slowness * ray.slowness;
  const double a = k * edge.c * std::abs(edge.dc_dz);
  const double b = 0.5 * k * std::abs(edge.c * edge.d2c_dz2 + edge.dc_dz * edge.dc_dz);
  const double root = a + std::sqrt(a * a + 4.0 * b * s2);
  const double scale = root > 0.0 ? 2.0 * s2 / root : layer.thickness();
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
  gauss_legendre(0.0, std::sqrt(near), [&](double u, double w) {
    const SoundSpeed water = layer.at(turn + sign * u * u);
    near_turn(water, std::sqrt(std::max(ray.sine2(water.c), 1e-300)), 2.0 * u * w);
  });
  const double hand_over = turn + sign * near;
  if (near < total) panels_from_flat_edge(layer, ray, hand_over, edge, near, direct);
  return hand_over;
}

}  // namespace asdic
