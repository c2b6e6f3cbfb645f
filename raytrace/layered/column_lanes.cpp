#include "raytrace/layered/column_lanes.h"

#include <algorithm>
#include <cmath>

#include "raytrace/layered/arc_series.h"
#include "raytrace/layered/layer_pass.h"
#include "raytrace/layered/smooth_quadrature.h"

namespace asdic {
namespace {

Rays atanh_over(const Rays& x) noexcept {
  if (all_of(abs(x) < short_series)) return atanh_series(x);
  return Rays([&](auto i) { return x[i] == 0.0 ? 1.0 : std::atanh(x[i]) / x[i]; });
}

Rays asin_over(const Rays& x) noexcept {
  if (all_of(abs(x) < short_series)) return asin_series(x);
  return Rays([&](auto i) {
    return x[i] == 0.0 ? 1.0 : std::asin(std::clamp<double>(x[i], -1.0, 1.0)) / x[i];
  });
}

/// Ray by ray, for what lanes do not know: `pass(RayParameter, sine_top, sine_bottom)` and
/// `detail(the same)`.
template <bool detailed, class PassOf, class DetailOf>
void one_by_one(const RayLanes& rays, LegLanes& leg, const PassOf& pass_of,
                const DetailOf& detail_of) noexcept {
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    const RayParameter ray(rays.reference_speed, rays.sigma[i]);
    const Pass pass = pass_of(ray, i);
    leg.per_slowness[i] += pass.range / ray.slowness;
    leg.d_range[i] += pass.d_range;
    if constexpr (detailed) {
      const PassDetail detail = detail_of(ray, i);
      leg.intercept[i] += detail.time - ray.slowness * pass.range;
      leg.length[i] += detail.length;
    }
  }
}

/// Gauss–Legendre nodes in depth, shared by all rays.
template <std::size_t n, bool detailed>
void cross_cubic(const Layer& layer, const RayLanes& rays, LegLanes& leg) noexcept {
  using Rule = GaussLegendre<n>;
  const double centre = 0.5 * (layer.top + layer.bottom) - layer.origin,
               half = 0.5 * layer.thickness();
  const auto [a0, a1, a2, a3] = layer.coefficient;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = centre + half * Rule::node[i], weight = half * Rule::weight[i];
    const double c = a0 + t * (a1 + t * (a2 + t * a3));
    const Rays s2 = rays.sine2(c), s = sqrt(s2), per_s = 1.0 / s;
    const Rays part = (weight * c) * per_s;
    leg.per_slowness += part;
    leg.d_range += part * (per_s * per_s);
    if constexpr (detailed) {
      leg.intercept += (weight / c) * s;
      leg.length += weight * per_s;
    }
  }
}

template <bool detailed>
void cross_smooth(const Layer& layer, const RayLanes& rays, const Rays& top, const Rays& bottom,
                  LegLanes& leg) noexcept {
  if (layer.law == Layer::Law::cubic) {
    // As few_nodes_suffice (layer_pass.cpp), for the flattest of the rays: on (0, 1) n nodes leave
    // ρ^(−2n) of a singularity at −x, ρ = v + √(v² − 1), v = 1 + 2x, x ≥ flat/(3·|rise|).
    const double steepest_rise =
        3.0 * std::abs(layer.c_top - layer.c_bottom) * (layer.c_top + layer.c_bottom) * rays.per_c2;
    const double flat = hmin(min(top, bottom));
    const double x = flat * flat / steepest_rise;
    if (x > 16.0) return cross_cubic<4, detailed>(layer, rays, leg);  // ρ ≥ 30: 30⁻⁸ = 2e-12
    if (x > 4.0) return cross_cubic<6, detailed>(layer, rays, leg);  // ρ ≥ 9.9: 9.9⁻¹² = 1e-12
    if (x > 0.7) return cross_cubic<8, detailed>(layer, rays, leg);  // ρ ≥ 4.6: 4.6⁻¹⁶ = 2e-11
  }
  one_by_one<detailed>(
      rays, leg,
      [&](const RayParameter& ray, std::size_t i) { return cross(layer, ray, top[i], bottom[i]); },
      [&](const RayParameter& ray, std::size_t i) {
        return cross_detail(layer, ray, top[i], bottom[i]);
      });
}

/// Formulae: docs/theory/layered-rays.md, and of times and lengths arc and parabola of
/// layer_pass.cpp.
template <bool detailed>
void cross_layer(const Layer& layer, const RayLanes& rays, const Rays& top, const Rays& bottom,
                 LegLanes& leg) noexcept {
  const double h = layer.thickness(), c_a = layer.c_top, c_b = layer.c_bottom;
  if (layer.law == Layer::Law::c_linear) {
    const Rays product = top * bottom;
    const Rays d_range = (c_a + c_b) * h / ((top + bottom) * product);
    const Rays chord = d_range * product;
    leg.per_slowness += chord;
    leg.d_range += d_range;
    if constexpr (detailed) {
      const Rays xi2 = rays.slowness * rays.slowness;
      const Rays y_time =
          chord * (1.0 + product) / (c_a * c_a + c_b * c_b - xi2 * (c_a * c_a * c_b * c_b));
      const Rays y_length = (c_a + c_b) * h / (top * c_b + bottom * c_a);
      leg.intercept += y_time * atanh_over(layer.gradient * y_time) - xi2 * chord;
      leg.length += y_length * asin_over(rays.slowness * (layer.gradient * y_length));
    }
  } else if (layer.law == Layer::Law::n2_linear) {
    const Rays w_a = top / c_a, w_b = bottom / c_b;
    const Rays per_slowness = 2.0 * h / (w_a + w_b), xi2 = rays.slowness * rays.slowness;
    leg.per_slowness += per_slowness;
    leg.d_range += per_slowness * (1.0 + xi2 / (w_a * w_b));
    if constexpr (detailed) {
      leg.intercept += per_slowness * (w_a * w_a + w_a * w_b + w_b * w_b) / 3.0;
      for (std::size_t i = 0; i < rays_at_once; ++i)
        leg.length[i] += cross_detail(layer, RayParameter(rays.reference_speed, rays.sigma[i]),
                                      top[i], bottom[i])
                             .length;
    }
  } else {
    cross_smooth<detailed>(layer, rays, top, bottom, leg);
  }
}

/// From the slower edge to the turning depth. c linear, gradient g: r = s/(ξ|g|), dr/dξ =
/// −1/(ξ²|g|s), τ = atanh(s)/|g|, ℓ = asin(s)/(ξ|g|).
template <bool detailed>
void turn_in_layer(const Layer& layer, const RayLanes& rays, const Rays& sine,
                   LegLanes& leg) noexcept {
  if (layer.law == Layer::Law::c_linear) {
    const double per_g = 1.0 / std::abs(layer.gradient);
    const Rays per_slowness = per_g * sine / (rays.slowness * rays.slowness);
    leg.per_slowness += per_slowness;
    leg.d_range -= per_slowness / (sine * sine);
    if constexpr (detailed) {
      leg.intercept += per_g * sine * (atanh_over(sine) - 1.0);
      leg.length += per_g * sine / rays.slowness * asin_over(sine);
    }
    return;
  }
  one_by_one<detailed>(
      rays, leg, [&](const RayParameter& ray, std::size_t i) { return turn(layer, ray, sine[i]); },
      [&](const RayParameter& ray, std::size_t i) { return turn_detail(layer, ray, sine[i]); });
}

/// From the top of layer `from` to the vertex. \return whether that is a turning point
template <bool detailed, bool down>
bool to_vertex(const std::vector<Layer>& layers, std::size_t from, const RayLanes& rays,
               LegLanes& leg) noexcept {
  const std::size_t count = down ? layers.size() - from : from;
  if (count == 0) return false;
  const Layer* layer = layers.data() + (down ? from : from - 1);
  Rays near = rays.sine(down ? layer->c_top : layer->c_bottom);
  for (std::size_t i = 0; i < count; ++i, down ? ++layer : --layer) {
    const Rays far2 = rays.sine2(down ? layer->c_bottom : layer->c_top);
    if (any_of(far2 <= 0.0)) {
      turn_in_layer<detailed>(*layer, rays, near, leg);
      return true;
    }
    const Rays far = sqrt(far2);
    cross_layer<detailed>(*layer, rays, down ? near : far, down ? far : near, leg);
    near = far;
  }
  return false;
}

/// Cuts inside an analytic law are no knots of the fan: rays of one interval turn in different
/// layers there, and each is walked by itself.
template <bool detailed>
ColumnLanes walk_one_by_one(const Column& column, const RayLanes& rays) noexcept {
  ColumnLanes sums;
  LegLanes* const legs[3] = {&sums.up, &sums.middle, &sums.down};
  Column::All one;
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    const RayParameter ray(rays.reference_speed, rays.sigma[i]);
    if (i == 0 || rays.sigma[i] != rays.sigma[i - 1]) {  // lanes left over repeat the last one
      if constexpr (detailed)
        one = column.all(ray);
      else
        one.sums = column.sums(ray);
    }
    const Pass* const passes[3] = {&one.sums.up, &one.sums.middle, &one.sums.down};
    const PassDetail* const details[3] = {&one.details.up, &one.details.middle, &one.details.down};
    for (std::size_t leg = 0; leg < 3; ++leg) {
      legs[leg]->per_slowness[i] = passes[leg]->range / ray.slowness;
      legs[leg]->d_range[i] = passes[leg]->d_range;
      if constexpr (detailed) {
        legs[leg]->intercept[i] = details[leg]->time - ray.slowness * passes[leg]->range;
        legs[leg]->length[i] = details[leg]->length;
      }
    }
  }
  sums.turns_above = one.sums.turns_above;
  sums.turns_below = one.sums.turns_below;
  return sums;
}

template <bool detailed>
ColumnLanes walk(const Column& column, const RayLanes& rays) noexcept {
  ColumnLanes sums;
  const auto& layers = column.layers();
  if (layers.front().law == Layer::Law::munk) return walk_one_by_one<detailed>(column, rays);
  if (column.upper() < column.lower()) {
    Rays top = rays.sine(layers[column.upper()].c_top);
    for (std::size_t i = column.upper(); i < column.lower(); ++i) {
      const Rays bottom = rays.sine(layers[i].c_bottom);
      cross_layer<detailed>(layers[i], rays, top, bottom, sums.middle);
      top = bottom;
    }
  }
  sums.turns_above = to_vertex<detailed, false>(layers, column.upper(), rays, sums.up);
  sums.turns_below = to_vertex<detailed, true>(layers, column.lower(), rays, sums.down);
  return sums;
}

}  // namespace

ColumnLanes walk_sums(const Column& column, const RayLanes& rays) noexcept {
  return walk<false>(column, rays);
}

ColumnLanes walk_all(const Column& column, const RayLanes& rays) noexcept {
  return walk<true>(column, rays);
}

}  // namespace asdic
