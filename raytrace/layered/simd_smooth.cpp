#include "raytrace/layered/simd_smooth.h"

#include <algorithm>
#include <cmath>

#include "raytrace/layered/layer_pass.h"
#include "raytrace/layered/simd_water.h"
#include "raytrace/layered/smooth_quadrature.h"
#include "raytrace/layered/turned_arc.h"

namespace asdic::detail {
namespace {

/// Ray by ray, for what lanes do not know: `pass_of(RayParameter, lane)` and `detail_of(the same)`.
template <bool detailed, class PassOf, class DetailOf>
void one_by_one(const SimdRays& rays, SimdLegs& leg, const PassOf& pass_of,
                const DetailOf& detail_of) noexcept {
  Pass pass;
  PassDetail detail;
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    const RayParameter ray(rays.reference_speed, rays.sigma[i]);
    if (i == 0 || rays.sigma[i] != rays.sigma[i - 1]) {  // lanes left over repeat the last one
      pass = pass_of(ray, i);
      if constexpr (detailed) detail = detail_of(ray, i);
    }
    leg.per_slowness[i] += pass.range / ray.slowness;
    leg.d_range[i] += pass.d_range;
    if constexpr (detailed) {
      leg.intercept[i] += detail.time - ray.slowness * pass.range;
      leg.length[i] += detail.length;
    }
  }
}

/// Gauss–Legendre nodes in depth, shared by all rays. \param least  s² of rays at the faster edge
template <std::size_t n, bool detailed>
void cross_at_shared_nodes(const Layer& layer, const SimdRays& rays, const Rays& least,
                           SimdLegs& leg) noexcept {
  using Rule = GaussLegendre<n>;
  const double half = 0.5 * layer.thickness();
  const double* const speed = layer.node_speed.data() + Layer::first_node<n>;
  for (std::size_t i = 0; i < n; ++i) {
    const double weight = half * Rule::weight[i], c = speed[i];
    const Rays s = sqrt(max(rays.sine2(c), least)), per_s = 1.0 / s;
    const Rays part = (weight * c) * per_s;
    leg.per_slowness += part;
    leg.d_range += part * (per_s * per_s);
    if constexpr (detailed) {
      leg.intercept += (weight / c) * s;
      leg.length += weight * per_s;
    }
  }
}

/// RayAlong (smooth_quadrature.h) for several rays: along ways that begin at one depth or, of T =
/// Rays, at several.
template <class T>
struct SimdAlong {
  T depth;            ///< where they begin [m]
  double sign;        ///< +1 down, −1 up
  T speed;            ///< there [m/s]
  Rays sine2;         ///< there
  SpeedDrop<T> drop;  ///< of a cubic law
  bool cubic;

  [[nodiscard]] Rays sine2_at(const SimdRays& rays, const Rays& t, const Rays& c) const noexcept {
    if (!cubic)
      return max((rays.reference_speed - c) * (rays.reference_speed + c) * rays.per_c2 +
                     rays.sigma * rays.sigma * (c * c * rays.per_c2),
                 Rays(1e-300));
    const Rays less = drop(t);
    return max(sine2 + rays.slowness * rays.slowness * less * (2.0 * speed - less), Rays(1e-300));
  }
};

/// What eight nodes in u = √(t + before) add: at_nodes_in_root, for several rays. `by_parts` gets
/// ∫ c″/(s c′²) dz.
template <bool detailed, class T>
void add_in_root(const Layer& layer, const SimdRays& rays, const SimdAlong<T>& way,
                 const Rays& before, const Rays& length, SimdLegs& sum, Rays& by_parts) noexcept {
  using Rule = GaussLegendre<8>;
  const Rays u_from = sqrt(before), u_to = sqrt(before + length);
  const Rays centre = 0.5 * (u_from + u_to), half = 0.5 * (u_to - u_from);
  for (std::size_t i = 0; i < 8; ++i) {
    const Rays u = centre + half * Rule::node[i], t = u * u - before;
    const SimdWater water(layer, way.depth + way.sign * t);
    const Rays& c = water.c;
    const Rays s2 = way.sine2_at(rays, t, c);
    const Rays per_s = 1.0 / sqrt(s2), dz = (2.0 * Rule::weight[i]) * u * half;
    const Rays part = dz * per_s;
    sum.per_slowness += part * c;
    sum.d_range += part * c * (per_s * per_s);
    by_parts += part * water.d2c_dz2 / (water.dc_dz * water.dc_dz);
    if constexpr (detailed) {
      sum.intercept += part * s2 / c;
      sum.length += part;
    }
  }
}

template <bool detailed>
void add(const SimdLegs& part, SimdLegs& leg) noexcept {
  leg.per_slowness += part.per_slowness;
  leg.d_range += part.d_range;
  if constexpr (detailed) {
    leg.intercept += part.intercept;
    leg.length += part.length;
  }
}

/// As integrate_evenly_bent; where the ray is nearly flat, ∂r/∂ξ by parts.
template <bool detailed>
void cross_evenly_bent(const Layer& layer, const SimdRays& rays, const Rays& sine_top,
                       const Rays& sine_bottom, SimdLegs& leg) noexcept {
  const bool flat_at_top = falls(layer);
  const double edge = flat_at_top ? layer.top : layer.bottom, sign = flat_at_top ? 1.0 : -1.0;
  const Rays s2 = flat_at_top ? sine_top * sine_top : sine_bottom * sine_bottom;
  const Rays far2 = flat_at_top ? sine_bottom * sine_bottom : sine_top * sine_top;
  const SoundSpeed top = layer.at(layer.top), bottom = layer.at(layer.bottom);
  const SoundSpeed& flat = flat_at_top ? top : bottom;
  const Rays xi2 = rays.slowness * rays.slowness;
  const Rays before = before_edge(s2, xi2, flat);
  const SimdAlong<double> way{.depth = edge,
                              .sign = sign,
                              .speed = flat_at_top ? layer.c_top : layer.c_bottom,
                              .sine2 = s2,
                              .drop = {flat.dc_dz, flat.d2c_dz2, layer.coefficient[3], sign},
                              .cubic = layer.law == Layer::Law::cubic};
  SimdLegs sum;
  Rays by_parts = 1.0 / (sine_bottom * layer.slope_bottom) - 1.0 / (sine_top * layer.slope_top);
  add_in_root<detailed>(layer, rays, way, before, Rays(layer.thickness()), sum, by_parts);
  where(s2 < 0.2 * far2, sum.d_range) = by_parts / xi2;
  add<detailed>(sum, leg);
}

/// The way from the slower edge to where the rays turn, at c = 1/ξ: Newton's method inside a
/// shrinking bracket, for the law is monotone in the layer, until the speed has risen by s²/(ξ²(1/ξ
/// + c)) but for its rounding; nodes crowd at the turning depth.
Rays ways_to_turn(const Layer& layer, const SimdRays& rays, const Rays& sine) noexcept {
  const bool downward = layer.c_bottom > layer.c_top, cubic = layer.law == Layer::Law::cubic;
  const double edge = downward ? layer.top : layer.bottom, sign = downward ? 1.0 : -1.0;
  const double c_edge = downward ? layer.c_top : layer.c_bottom, h = layer.thickness();
  const SpeedDrop<double> drop = speed_drop(layer, edge, sign);
  const Rays target = 1.0 / rays.slowness;
  const Rays rise = sine * sine * target * (target / (target + c_edge));
  // Speeds beyond a cubic's are known to 2e-16 of themselves only.
  const Rays rounding = cubic ? 1e-16 * rise : 2e-16 * target;
  Rays low = 0.0, high = h;
  Rays t = h * min(max(rise / std::abs(layer.c_bottom - layer.c_top), Rays(0.0)), Rays(1.0));
  Rays::mask_type done(false);
  for (int i = 0; i < 60; ++i) {
    Rays off, slope;
    if (cubic) {
      off = rise + drop(t);
      slope = -drop.slope(t);
    } else {
      const SimdWater here(layer, edge + sign * t);
      off = target - here.c;
      slope = sign * here.dc_dz;
    }
    done = done || (abs(off) <= rounding && rounding <= 1e-12 * t * slope);
    const auto slower = off > 0.0;
    where(slower, low) = t;
    where(!slower, high) = t;
    Rays next = t + off / slope;
    where(!(next > low && next < high), next) = 0.5 * (low + high);
    const Rays step = abs(next - t);
    where(!done, t) = next;
    done = done || step <= 1e-15 * next;
    if (all_of(done)) break;
  }
  return t;
}

}  // namespace

template <bool detailed>
void cross_smooth(const Layer& layer, const SimdRays& rays, const Rays& sine_top,
                  const Rays& sine_bottom, SimdLegs& leg) noexcept {
  if (layer.gentle) {
    // As few_nodes_suffice (layer_pass.cpp), for the flattest of the rays: on (0, 1) n nodes leave
    // ρ^(−2n) of a singularity at −x, ρ = v + √(v² − 1), v = 1 + 2x, x ≥ flat/(3·|rise|).
    const double steepest_rise =
        3.0 * std::abs(layer.c_top - layer.c_bottom) * (layer.c_top + layer.c_bottom) * rays.per_c2;
    const Rays flattest = min(sine_top, sine_bottom), least = flattest * flattest;
    const double x = hmin(least) / steepest_rise;
    if (x > 16.0)  // ρ ≥ 30: 30⁻⁸ = 2e-12
      return cross_at_shared_nodes<4, detailed>(layer, rays, least, leg);
    if (x > 4.0)  // ρ ≥ 9.9: 9.9⁻¹² = 1e-12
      return cross_at_shared_nodes<6, detailed>(layer, rays, least, leg);
    if (x > 0.7)  // ρ ≥ 4.6: 4.6⁻¹⁶ = 2e-11
      return cross_at_shared_nodes<8, detailed>(layer, rays, least, leg);
  }
  if (layer.evenly_bent)
    return cross_evenly_bent<detailed>(layer, rays, sine_top, sine_bottom, leg);
  one_by_one<detailed>(
      rays, leg,
      [&](const RayParameter& ray, std::size_t i) {
        return cross(layer, ray, sine_top[i], sine_bottom[i]);
      },
      [&](const RayParameter& ray, std::size_t i) {
        return cross_detail(layer, ray, sine_top[i], sine_bottom[i]);
      });
}

template <bool detailed>
void turn_smooth(const Layer& layer, const SimdRays& rays, const Rays& sine,
                 SimdLegs& leg) noexcept {
  const bool downward = layer.c_bottom > layer.c_top;
  const double edge = downward ? layer.top : layer.bottom;
  const double sign = downward ? -1.0 : 1.0;  // from the turning depth towards the edge
  const SoundSpeed at_edge = layer.at(edge);
  const Rays total = ways_to_turn(layer, rays, sine), turn_z = edge - sign * total;
  const SimdWater there(layer, turn_z);
  using Arc = TurnedArc<Rays>;
  const double gradient = std::abs(at_edge.dc_dz);
  const auto straight = total * std::abs(at_edge.d2c_dz2) < Arc::straightest * gradient &&
                        Arc::reaches(sine, rays.slowness, gradient, total);
  const Rays half_slope = 0.5 * abs(there.dc_dz);
  const auto one_piece = abs(there.d2c_dz2) * total <= half_slope && half_slope <= gradient;
  if (!all_of(straight || one_piece))
    return one_by_one<detailed>(
        rays, leg,
        [&](const RayParameter& ray, std::size_t i) { return turn(layer, ray, sine[i]); },
        [&](const RayParameter& ray, std::size_t i) { return turn_detail(layer, ray, sine[i]); });
  const SimdAlong<Rays> way{.depth = turn_z,
                            .sign = sign,
                            .speed = 1.0 / rays.slowness,
                            .sine2 = 0.0,
                            .drop = {there.dc_dz, there.d2c_dz2, layer.coefficient[3], sign},
                            .cubic = layer.law == Layer::Law::cubic};
  SimdLegs sum;
  Rays by_parts = sign / (sine * at_edge.dc_dz);
  add_in_root<detailed>(layer, rays, way, Rays(0.0), total, sum, by_parts);
  sum.d_range = by_parts / (rays.slowness * rays.slowness);
  if (any_of(straight)) {
    const Arc arc(sine, rays.slowness, gradient, at_edge.d2c_dz2);
    where(straight, sum.per_slowness) = arc.per_slowness;
    where(straight, sum.d_range) = arc.d_range;
    if constexpr (detailed) {
      where(straight, sum.intercept) = arc.intercept;
      where(straight, sum.length) = arc.length;
    }
  }
  add<detailed>(sum, leg);
}

template void cross_smooth<true>(const Layer&, const SimdRays&, const Rays&, const Rays&,
                                 SimdLegs&) noexcept;
template void cross_smooth<false>(const Layer&, const SimdRays&, const Rays&, const Rays&,
                                  SimdLegs&) noexcept;
template void turn_smooth<true>(const Layer&, const SimdRays&, const Rays&, SimdLegs&) noexcept;
template void turn_smooth<false>(const Layer&, const SimdRays&, const Rays&, SimdLegs&) noexcept;

}  // namespace asdic::detail
