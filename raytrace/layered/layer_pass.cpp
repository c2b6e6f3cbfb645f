#include "raytrace/layered/layer_pass.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/arc_series.h"
#include "raytrace/layered/smooth_quadrature.h"
#include "raytrace/layered/turned_arc.h"

namespace asdic::detail {
namespace {

/// (atanh x)/x and (asin x)/x, for |x| < 1, without cancellation at 0.
double atanh_over(double x) {
  return std::abs(x) > short_series ? std::atanh(x) / x : atanh_series(x);
}
double asin_over(double x) {
  return std::abs(x) > short_series ? std::asin(std::clamp(x, -1.0, 1.0)) / x : asin_series(x);
}

/// Whether a turning piece is to be a TurnedArc.
bool is_straight(const Layer& layer, const RayParameter& ray, double turn, double edge,
                 double sine) {
  const SoundSpeed there = layer.at(edge);
  const double gradient = std::abs(there.dc_dz), way = std::abs(turn - edge);
  return way * std::abs(there.d2c_dz2) < TurnedArc<double>::straightest * gradient &&
         TurnedArc<double>::reaches(sine, ray.slowness, gradient, way);
}

TurnedArc<double> turned_arc(const Layer& layer, const RayParameter& ray, double edge,
                             double sine) {
  const SoundSpeed there = layer.at(edge);
  return {sine, ray.slowness, std::abs(there.dc_dz), there.d2c_dz2};
}

/// At few nodes where the ray is steep enough all through the layer; \return whether it was.
template <class F>
bool few_nodes_suffice(const Layer& layer, const RayParameter& ray, double sine_top,
                       double sine_bottom, F&& f) {
  if (layer.law != Layer::Law::cubic) return false;
  // s² doubles after at least a third of flat/(steep − flat) thicknesses: a monotone cubic is
  // nowhere three times steeper than its secant. Bernstein: on (0, 1) the error of n nodes for a
  // singularity at −x falls as ρ^(−2n), ρ = v + √(v² − 1), v = 1 + 2x.
  const double a = sine_top * sine_top, b = sine_bottom * sine_bottom;
  const double flat = std::min(a, b), rise = 3.0 * std::abs(a - b);
  const auto way = RayAlong::from_flat_edge(layer, ray, sine_top, sine_bottom);
  if (flat > 16.0 * rise)  // ρ ≥ 66: 66^−8
    at_cubic_nodes<4>(way, 0.0, layer.thickness(), f);
  else if (flat > 0.7 * rise)  // ρ ≥ 4.6: 4.6^−16 = 2e-11
    at_cubic_nodes<8>(way, 0.0, layer.thickness(), f);
  else
    return false;
  return true;
}

/// c linear between two depths at distance h where the speeds are c_a, c_b and the sines s_a, s_b.
/// Arc of a circle.
PassDetail arc(double c_a, double c_b, double s_a, double s_b, double h, double gradient,
               double slowness) {
  // time = (1/g)·atanh[(s_a − s_b)/(1 − s_a s_b)], length = asin[s_a·ξc_b − s_b·ξc_a]/(ξg), both
  // rearranged to hold as g → 0 and ξ → 0.
  const double a2 = slowness * slowness * c_a * c_a;
  const double y_time =
      (c_a + c_b) * h / (s_a + s_b) * (1.0 + s_a * s_b) / (c_a * c_a + c_b * c_b - a2 * c_b * c_b);
  const double y_length = (c_a + c_b) * h / (s_a * c_b + s_b * c_a);
  return {.time = y_time * atanh_over(gradient * y_time),
          .length = y_length * asin_over(slowness * gradient * y_length)};
}

/// 1/c² linear, gradient g: time = ∫w dz + ξΔr; length = ∫ n/w dz = [Δ(nw) + ξ²Δln(n + w)]/g, n =
/// 1/c, w = s/c, in which Δn = gh/Σn, Δw = gh/Σw and Δln(n + w) = 2·atanh(x), x = Δ(n + w)/Σ(n +
/// w), so that g cancels.
PassDetail parabola(double n_a, double n_b, double w_a, double w_b, double h, double gradient,
                    double slowness) {
  const double sum_w = w_a + w_b, sum_n = n_a + n_b, xi2 = slowness * slowness;
  const double time = 2.0 * h / sum_w * ((w_a * w_a + w_a * w_b + w_b * w_b) / 3.0 + xi2);
  const double x_over_g = h * (1.0 / sum_n + 1.0 / sum_w) / (sum_n + sum_w);
  const double length =
      h * (n_b / sum_w + w_a / sum_n) + 2.0 * xi2 * x_over_g * atanh_over(gradient * x_over_g);
  return {.time = time, .length = length};
}

/// Newton inside a shrinking bracket: the law is monotone in the layer.
double turning_depth_by_speed(const Layer& layer, double target) {
  const double span = layer.c_bottom - layer.c_top;
  double low = layer.top, high = layer.bottom;
  double z = low + (high - low) * std::clamp((target - layer.c_top) / span, 0.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    const SoundSpeed here = layer.at(z);
    ((here.c < target) == (span > 0.0) ? low : high) = z;
    const double step = here.dc_dz != 0.0 ? (target - here.c) / here.dc_dz : 0.0;
    double next = z + step;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - z) <= 1e-15 * (std::abs(z) + 1.0)) return next;
    z = next;
  }
  return z;
}

/// From the edge whose speed is nearer to that of the turn, by the difference of the two, which the
/// sine at the edge tells: s² = ξ²(c_turn − c)(c_turn + c).
double turning_depth_of_cubic(const Layer& layer, const RayParameter& ray) {
  const double turning = ray.turning_speed();
  const auto rise_to_turn = [&](double c) {
    return ray.sine2(c) / (ray.slowness * ray.slowness * (turning + c));
  };
  const double from_top = rise_to_turn(layer.c_top), from_bottom = rise_to_turn(layer.c_bottom);
  const bool at_top = std::abs(from_top) < std::abs(from_bottom);
  const double edge = at_top ? layer.top : layer.bottom, sign = at_top ? 1.0 : -1.0;
  const SpeedDrop<double> drop = speed_drop(layer, edge, sign);
  const double wanted = at_top ? -from_top : -from_bottom, h = layer.thickness();
  const bool falls =
      (at_top ? layer.c_bottom : layer.c_top) < (at_top ? layer.c_top : layer.c_bottom);
  double low = 0.0, high = h;
  double t = h * std::clamp(wanted / drop(h), 0.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    const double off = wanted - drop(t);
    ((off > 0.0) == falls ? low : high) = t;
    double next = t + off / drop.slope(t);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-15 * next) return edge + sign * next;
    t = next;
  }
  return edge + sign * t;
}

}  // namespace

double turning_depth(const Layer& layer, const RayParameter& ray) noexcept {
  const double target = ray.turning_speed();
  if (layer.law == Layer::Law::c_linear)
    return layer.c_bottom > layer.c_top ? layer.bottom - (layer.c_bottom - target) / layer.gradient
                                        : layer.top + (target - layer.c_top) / layer.gradient;
  if (layer.law == Layer::Law::n2_linear)
    return layer.top +
           (ray.slowness * ray.slowness - 1.0 / (layer.c_top * layer.c_top)) / layer.gradient;
  return layer.law == Layer::Law::cubic ? turning_depth_of_cubic(layer, ray)
                                        : turning_depth_by_speed(layer, target);
}

Pass cross(const Layer& layer, const RayParameter& ray, double sine_top,
           double sine_bottom) noexcept {
  const double xi = ray.slowness, h = layer.thickness();
  if (layer.law == Layer::Law::c_linear) return cross_c_linear(layer, ray, sine_top, sine_bottom);
  if (layer.law == Layer::Law::n2_linear) {
    const double w_a = sine_top / layer.c_top, w_b = sine_bottom / layer.c_bottom;
    const double per_xi = 2.0 * h / (w_a + w_b);
    return {.range = xi * per_xi, .d_range = per_xi * (1.0 + xi * xi / (w_a * w_b))};
  }
  Pass pass;
  const auto add = [&](double c, double per_s, double dz) {
    const double c_over_s = dz * c * per_s;
    pass.range += c_over_s;                    // dr = (ξc/s) dz
    pass.d_range += c_over_s * per_s * per_s;  // ∂/∂ξ of it: c/s³ dz
  };
  if (few_nodes_suffice(layer, ray, sine_top, sine_bottom, add)) {
  } else if (layer.evenly_bent) {
    // Where the ray is nearly flat, by parts: (2) of docs/theory/layered-rays.md, whose integrand
    // is smooth. Elsewhere its terms would cancel.
    const double top2 = sine_top * sine_top, bottom2 = sine_bottom * sine_bottom;
    const bool flat = std::min(top2, bottom2) < 0.2 * std::max(top2, bottom2);
    double by_parts = 1.0 / (sine_bottom * layer.at(layer.bottom).dc_dz) -
                      1.0 / (sine_top * layer.at(layer.top).dc_dz);
    integrate_evenly_bent(RayAlong::from_flat_edge(layer, ray, sine_top, sine_bottom),
                          [&](const SoundSpeed& water, double per_s, double dz) {
                            add(water.c, per_s, dz);
                            by_parts += dz * water.d2c_dz2 * per_s / (water.dc_dz * water.dc_dz);
                          });
    if (flat) pass.d_range = by_parts / (xi * xi);
  } else {
    integrate_crossing(RayAlong::from_flat_edge(layer, ray, sine_top, sine_bottom), add);
  }
  pass.range *= xi;
  return pass;
}

PassDetail cross_detail(const Layer& layer, const RayParameter& ray, double sine_top,
                        double sine_bottom) noexcept {
  const double h = layer.thickness();
  if (layer.law == Layer::Law::c_linear)
    return arc(layer.c_top, layer.c_bottom, sine_top, sine_bottom, h, layer.gradient, ray.slowness);
  if (layer.law == Layer::Law::n2_linear)
    return parabola(1.0 / layer.c_top, 1.0 / layer.c_bottom, sine_top / layer.c_top,
                    sine_bottom / layer.c_bottom, h, layer.gradient, ray.slowness);
  PassDetail detail;
  const auto add = [&](double c, double per_s, double dz) {
    detail.time += dz * per_s / c;
    detail.length += dz * per_s;
  };
  if (few_nodes_suffice(layer, ray, sine_top, sine_bottom, add)) {
  } else if (layer.evenly_bent) {
    integrate_evenly_bent(
        RayAlong::from_flat_edge(layer, ray, sine_top, sine_bottom),
        [&](const SoundSpeed& water, double per_s, double dz) { add(water.c, per_s, dz); });
  } else {
    integrate_crossing(RayAlong::from_flat_edge(layer, ray, sine_top, sine_bottom), add);
  }
  return detail;
}

Pass turn(const Layer& layer, const RayParameter& ray, double sine) noexcept {
  const double xi = ray.slowness;
  const bool downward = layer.c_bottom > layer.c_top;
  const double edge = downward ? layer.top : layer.bottom,
               c_edge = downward ? layer.c_top : layer.c_bottom;
  if (layer.law == Layer::Law::c_linear) {  // r = s/(ξ|g|), dr/dξ = −1/(ξ²|g|s)
    const double range = sine / (xi * std::abs(layer.gradient));
    return {.range = range, .d_range = -range / (xi * sine * sine)};
  }
  if (layer.law == Layer::Law::n2_linear) {  // r = 2ξw/|b|, dr/dξ = (2/|b|)(w − ξ²/w)
    const double w = sine / c_edge, two_over_b = 2.0 / std::abs(layer.gradient);
    return {.range = xi * two_over_b * w, .d_range = two_over_b * (w - xi * xi / w)};
  }
  const double turn_z = turning_depth(layer, ray);
  if (is_straight(layer, ray, turn_z, edge, sine)) {
    const auto arc = turned_arc(layer, ray, edge, sine);
    return {.range = xi * arc.per_slowness, .d_range = arc.d_range};
  }

  // Near the turning point dr/dξ = (1/ξ²){[1/(s c')] + ∫ c″/(s c'²) dz} (by parts, the end at s = 0
  // dropped); ∫ c/s³ dz beyond.
  Pass pass;
  double by_parts = 0.0;
  const double orientation = downward ? -1.0 : 1.0;  // dz from the turning depth to the edge
  const HandOver end = integrate_turning(
      layer, ray, turn_z,
      [&](double c, double per_s, double dz) {
        pass.range += dz * c * per_s;
        pass.d_range += dz * c * per_s * per_s * per_s;
      },
      [&](const SoundSpeed& water, double per_s, double dz) {
        pass.range += dz * water.c * per_s;
        by_parts += dz * water.d2c_dz2 * per_s / (water.dc_dz * water.dc_dz);
      });
  const double s_end = end.depth == edge ? sine : std::sqrt(end.sine2);
  by_parts += orientation / (s_end * layer.at(end.depth).dc_dz);
  pass.range *= xi;
  pass.d_range += by_parts / (xi * xi);
  return pass;
}

PassDetail turn_detail(const Layer& layer, const RayParameter& ray, double sine) noexcept {
  const bool downward = layer.c_bottom > layer.c_top;
  const double edge = downward ? layer.top : layer.bottom,
               c_edge = downward ? layer.c_top : layer.c_bottom;
  if (layer.law == Layer::Law::c_linear) {  // τ = atanh(s)/|g|, ℓ = asin(s)/(ξ|g|)
    const double per_g = sine / std::abs(layer.gradient);
    return {.time = per_g * atanh_over(sine), .length = per_g * asin_over(sine) / ray.slowness};
  }
  if (layer.law == Layer::Law::n2_linear) {
    const double w = sine / c_edge, b = std::abs(layer.gradient);
    return parabola(1.0 / c_edge, ray.slowness, w, 0.0, w * w / b, -b, ray.slowness);
  }
  const double turn_z = turning_depth(layer, ray);
  if (is_straight(layer, ray, turn_z, edge, sine)) {
    const auto arc = turned_arc(layer, ray, edge, sine);
    return {.time = arc.intercept + ray.slowness * ray.slowness * arc.per_slowness,
            .length = arc.length};
  }
  PassDetail detail;
  const auto add = [&](double c, double per_s, double dz) {
    detail.time += dz * per_s / c;
    detail.length += dz * per_s;
  };
  integrate_turning(layer, ray, turn_z, add, [&](const SoundSpeed& water, double per_s, double dz) {
    add(water.c, per_s, dz);
  });
  return detail;
}

}  // namespace asdic::detail
