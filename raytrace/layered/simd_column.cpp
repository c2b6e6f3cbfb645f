#include "raytrace/layered/simd_column.h"

#include <algorithm>
#include <cmath>

#include "raytrace/layered/simd_smooth.h"

namespace asdic::detail {
namespace {

/// ∫ n/w dz of a parabola, n = 1/c, w = s/c, d(n²)/dz = g: [Δ(nw) + ξ²Δln(n + w)]/g, in which
/// Δn = gh/Σn, Δw = gh/Σw and Δln(n + w) = 2·atanh(x) = 2(x/g)·g·(atanh x)/x, x = Δ(n + w)/Σ(n +
/// w), so that g cancels.
template <class Slowness>
Rays parabola_length(const Rays& h, double g, double n_a, const Slowness& n_b, const Rays& w_a,
                     const Rays& w_b, const Rays& xi2) noexcept {
  const Rays sum_n = n_a + n_b, sum_w = w_a + w_b;
  const Rays x_over_g = h * (1.0 / sum_n + 1.0 / sum_w) / (sum_n + sum_w);
  return h * (n_b / sum_w + w_a / sum_n) + 2.0 * xi2 * x_over_g * atanh_over(g * x_over_g);
}

}  // namespace

/// Formulae: docs/theory/layered-rays.md, and of times and lengths arc and parabola of
/// layer_pass.cpp.
template <bool detailed>
void cross_layer(const Layer& layer, const SimdRays& rays, const Rays& top, const Rays& bottom,
                 SimdLegs& leg) noexcept {
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
      leg.length += parabola_length(h, layer.gradient, 1.0 / c_a, 1.0 / c_b, w_a, w_b, xi2);
    }
  } else {
    cross_smooth<detailed>(layer, rays, top, bottom, leg);
  }
}

/// From the slower edge to the turning depth. c linear, gradient g: r = s/(ξ|g|), dr/dξ =
/// −1/(ξ²|g|s), τ = atanh(s)/|g|, ℓ = asin(s)/(ξ|g|).
template <bool detailed>
void turn_in_layer(const Layer& layer, const SimdRays& rays, const Rays& sine,
                   SimdLegs& leg) noexcept {
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
  if (layer.law == Layer::Law::n2_linear) {  // r = 2ξw/|b|, dr/dξ = (2/|b|)(w − ξ²/w), from n to ξ
    const double c_edge = std::min(layer.c_top, layer.c_bottom), b = std::abs(layer.gradient);
    const Rays w = sine / c_edge, per_slowness = 2.0 / b * w;
    leg.per_slowness += per_slowness;
    leg.d_range += per_slowness - 2.0 / b * rays.slowness * rays.slowness / w;
    if constexpr (detailed) {
      leg.intercept += per_slowness * w * w / 3.0;
      leg.length += parabola_length(w * w / b, -b, 1.0 / c_edge, rays.slowness, w, Rays(0.0),
                                    rays.slowness * rays.slowness);
    }
    return;
  }
  turn_smooth<detailed>(layer, rays, sine, leg);
}

template void cross_layer<true>(const Layer&, const SimdRays&, const Rays&, const Rays&,
                                SimdLegs&) noexcept;
template void cross_layer<false>(const Layer&, const SimdRays&, const Rays&, const Rays&,
                                 SimdLegs&) noexcept;
template void turn_in_layer<true>(const Layer&, const SimdRays&, const Rays&, SimdLegs&) noexcept;
template void turn_in_layer<false>(const Layer&, const SimdRays&, const Rays&, SimdLegs&) noexcept;

namespace {

template <bool detailed>
void add_to(const Rays::mask_type& these, const SimdLegs& part, SimdLegs& leg) noexcept {
  where(these, leg.per_slowness) += part.per_slowness;
  where(these, leg.d_range) += part.d_range;
  if constexpr (detailed) {
    where(these, leg.intercept) += part.intercept;
    where(these, leg.length) += part.length;
  }
}

/// From the top of layer `from` to the vertex. \return whether that is a turning point
template <bool detailed, bool down>
bool to_vertex(const std::vector<Layer>& layers, std::size_t from, const SimdRays& rays,
               SimdLegs& leg) noexcept {
  const std::size_t count = down ? layers.size() - from : from;
  if (count == 0) return false;
  const Layer* layer = layers.data() + (down ? from : from - 1);
  Rays near = rays.sine(down ? layer->c_top : layer->c_bottom);
  for (std::size_t i = 0; i < count; ++i, down ? ++layer : --layer) {
    const Rays far2 = rays.sine2(down ? layer->c_bottom : layer->c_top);
    const auto turned = far2 <= 0.0;
    if (any_of(turned)) {
      // Cuts inside an analytic law are no knots of the fan: its rays may turn in different layers.
      if (layer->law != Layer::Law::munk || all_of(turned)) {
        turn_in_layer<detailed>(*layer, rays, near, leg);
        return true;
      }
      const SimdRays here = only(rays, turned), others = only(rays, !turned);
      SimdLegs turning, beyond;
      turn_in_layer<detailed>(*layer, here, here.sine(down ? layer->c_top : layer->c_bottom),
                              turning);
      to_vertex<detailed, down>(layers, down ? from + i : from - i, others, beyond);
      add_to<detailed>(turned, turning, leg);
      add_to<detailed>(!turned, beyond, leg);
      return true;
    }
    const Rays far = sqrt(far2);
    cross_layer<detailed>(*layer, rays, down ? near : far, down ? far : near, leg);
    near = far;
  }
  return false;
}

template <bool detailed>
SimdColumn walk(const Column& column, const SimdRays& rays) noexcept {
  SimdColumn sums;
  const auto& layers = column.layers();
  sums.middle = cross_layers<detailed>(column, column.upper(), column.lower(), rays);
  sums.turns_above = to_vertex<detailed, false>(layers, column.upper(), rays, sums.up);
  sums.turns_below = to_vertex<detailed, true>(layers, column.lower(), rays, sums.down);
  return sums;
}

}  // namespace

LayerVisit visit_layer(const Layer& layer, const SimdRays& rays, double between,
                       SimdLegs& leg) noexcept {
  const double slower = std::min(layer.c_top, layer.c_bottom),
               faster = std::max(layer.c_top, layer.c_bottom);
  using Mask = Rays::mask_type;
  LayerVisit visit{Mask(faster < between), Mask(slower < between && faster >= between)};
  if (layer.law == Layer::Law::munk) {
    visit.crossed = rays.sine2(faster) > 0.0;
    visit.turned = rays.sine2(slower) > 0.0 && !visit.crossed;
  }
  SimdLegs part;
  if (any_of(visit.crossed)) {
    const SimdRays those = only(rays, visit.crossed);
    cross_layer<false>(layer, those, those.sine(layer.c_top), those.sine(layer.c_bottom), part);
    add_to<false>(visit.crossed, part, leg);
  }
  if (any_of(visit.turned)) {
    const SimdRays those = only(rays, visit.turned);
    part = {};
    turn_in_layer<false>(layer, those, those.sine(slower), part);
    add_to<false>(visit.turned, part, leg);
  }
  return visit;
}

template <bool detailed>
SimdLegs cross_layers(const Column& column, std::size_t first, std::size_t last,
                      const SimdRays& rays) noexcept {
  SimdLegs sum;
  if (first == last) return sum;
  const std::vector<Layer>& layers = column.layers();
  Rays top = rays.sine(layers[first].c_top);
  for (std::size_t i = first; i < last; ++i) {
    const Rays bottom = rays.sine(layers[i].c_bottom);
    cross_layer<detailed>(layers[i], rays, top, bottom, sum);
    top = bottom;
  }
  return sum;
}

template SimdLegs cross_layers<true>(const Column&, std::size_t, std::size_t,
                                     const SimdRays&) noexcept;
template SimdLegs cross_layers<false>(const Column&, std::size_t, std::size_t,
                                      const SimdRays&) noexcept;

SimdColumn walk_sums(const Column& column, const SimdRays& rays) noexcept {
  return walk<false>(column, rays);
}

SimdColumn walk_all(const Column& column, const SimdRays& rays) noexcept {
  return walk<true>(column, rays);
}

}  // namespace asdic::detail
