#include "raytrace/layered/layer.h"

#include <algorithm>
#include <cmath>

#include "raytrace/layered/simd_water.h"
#include "raytrace/math/gauss_legendre.h"

namespace asdic::detail {
namespace {

/// Depths strictly inside (top, bottom) where the layer is cut: where dc/dz changes sign, and for
/// Munk's law more.
std::vector<double> inner_cuts(const Layer& layer) {
  std::vector<double> found;
  const auto keep = [&](double z) {
    const double margin = 1e-9 * (layer.bottom - layer.top);
    if (z > layer.top + margin && z < layer.bottom - margin) found.push_back(z);
  };
  // The axis, cuts between which dc/dz ∝ 1 − e^−η hardly doubles, and below them such that eight
  // nodes see d²c/dz² ∝ e^−η fall.
  if (layer.law == Layer::Law::munk) {
    for (const double eta : {-4.0, -3.4, -2.8, -2.2, -1.75, -1.35, -1.0, -0.7, -0.5, -0.34, -0.19,
                             -0.1, 0.0,  0.1,  0.2,  0.4,   0.9,   1.7,  2.8,  4.2,  6.5})
      keep(layer.coefficient[1] + 0.5 * eta * layer.coefficient[2]);
  }
  if (layer.law ==
      Layer::Law::cubic) {  // c' = a₁ + 2a₂t + 3a₃t², by the formula that does not cancel
    const double a = 3.0 * layer.coefficient[3], b = 2.0 * layer.coefficient[2],
                 c = layer.coefficient[1];
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant > 0.0) {
      const double half = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
      if (a != 0.0) keep(layer.origin + half / a);
      if (half != 0.0) keep(layer.origin + c / half);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// What quadratures of a smooth law want to know of a layer.
void prepare_quadrature(Layer& layer) {
  if (layer.closed_form()) return;
  constexpr std::size_t nodes = std::tuple_size_v<decltype(layer.node_speed)>, edges = nodes;
  std::array<double, nodes + 2 + rays_at_once> depth, speed,
      slope;  // nodes, edges, what fills lanes
  depth.fill(layer.top);
  double* z = depth.data();
  const auto put = [&](double node, double) { *z++ = node; };
  gauss_legendre<4>(layer.top, layer.bottom, put);
  gauss_legendre<6>(layer.top, layer.bottom, put);
  gauss_legendre<8>(layer.top, layer.bottom, put);
  depth[edges + 1] = layer.bottom;
  for (std::size_t i = 0; i < nodes + 2; i += rays_at_once) {
    const SimdWater water(layer, load(&depth[i]));
    store(water.c, &speed[i]);
    store(water.dc_dz, &slope[i]);
  }
  std::copy_n(speed.begin(), nodes, layer.node_speed.begin());
  layer.slope_top = slope[edges];
  layer.slope_bottom = slope[edges + 1];
  // A monotone cubic is nowhere three times steeper than its secant; Munk's law is steepest at an
  // end.
  const double secant = std::abs(layer.c_bottom - layer.c_top) / layer.thickness();
  layer.gentle = layer.law == Layer::Law::cubic ||
                 std::max(std::abs(layer.slope_top), std::abs(layer.slope_bottom)) <= 3.0 * secant;
}

/// The part of a layer between two depths inside it. The speeds at kept ends stay the same to the
/// last bit.
Layer slice(const Layer& layer, double top, double bottom) {
  Layer part = layer;
  if (top != layer.top) part.c_top = layer.at(top).c;
  if (bottom != layer.bottom) part.c_bottom = layer.at(bottom).c;
  part.top = top;
  part.bottom = bottom;
  prepare_quadrature(part);
  return part;
}

bool is_evenly_bent(const Layer& layer) {
  double least = 1e300, most = 0.0;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double slope = std::abs(layer.at(layer.top + share * layer.thickness()).dc_dz);
    least = std::min(least, slope);
    most = std::max(most, slope);
  }
  return least > 0.5 * most;
}

/// The layer between two depths with no sample of the profile between them.
Layer interval_layer(const SoundSpeedProfile& water, double top, double bottom) {
  const SoundSpeed upper = water.at(top), lower = water.at(bottom);
  Layer layer{.top = top, .bottom = bottom, .c_top = upper.c, .c_bottom = lower.c};
  const double h = bottom - top;
  if (const auto& munk = water.munk_parameters()) {
    layer.law = Layer::Law::munk;
    layer.coefficient = {munk->axis_speed, munk->axis_depth, munk->scale_depth, munk->perturbation};
  } else if (water.depths().size() < 2 || water.interpolation() == Interpolation::c_linear) {
    layer.gradient = (lower.c - upper.c) / h;
  } else if (water.interpolation() == Interpolation::n2_linear) {
    layer.law = Layer::Law::n2_linear;
    layer.gradient = (1.0 / (lower.c * lower.c) - 1.0 / (upper.c * upper.c)) / h;
  } else {  // the Hermite cubic through both ends' speeds and slopes
    layer.law = Layer::Law::cubic;
    layer.origin = top;
    const double secant = (lower.c - upper.c) / h;
    layer.coefficient = {upper.c, upper.dc_dz, (3.0 * secant - 2.0 * upper.dc_dz - lower.dc_dz) / h,
                         (upper.dc_dz + lower.dc_dz - 2.0 * secant) / (h * h)};
  }
  return layer;
}

}  // namespace

SoundSpeed Layer::at(double depth) const noexcept {
  switch (law) {
    case Law::c_linear:
      return {c_top + gradient * (depth - top), gradient, 0.0};
    case Law::n2_linear: {  // c' = −c³/2·d(n²)/dz, c″ = 3c'²/c
      const double c = 1.0 / std::sqrt(1.0 / (c_top * c_top) + gradient * (depth - top));
      const double slope = -0.5 * c * c * c * gradient;
      return {c, slope, 3.0 * slope * slope / c};
    }
    case Law::cubic: {
      const double t = depth - origin;
      const auto& a = coefficient;
      return {a[0] + t * (a[1] + t * (a[2] + t * a[3])), a[1] + t * (2.0 * a[2] + 3.0 * t * a[3]),
              2.0 * a[2] + 6.0 * t * a[3]};
    }
    case Law::munk:
      break;
  }
  const auto& [c1, z1, scale, epsilon] =
      coefficient;  // c = c₁[1 + ε(η − 1 + e^−η)], η = 2(z − z₁)/B
  const double eta = 2.0 * (depth - z1) / scale, decay = std::exp(-eta);
  const double k = 2.0 / scale;
  return {c1 * (1.0 + epsilon * (eta - 1.0 + decay)), c1 * epsilon * k * (1.0 - decay),
          c1 * epsilon * k * k * decay};
}

std::vector<Layer> make_layers(const SoundSpeedProfile& water, double top, double bottom) {
  std::vector<double> cuts = {top};
  for (const double z : water.depths())
    if (z > top && z < bottom) cuts.push_back(z);
  cuts.push_back(bottom);

  std::vector<Layer> layers;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const Layer whole = interval_layer(water, cuts[i], cuts[i + 1]);
    double from = whole.top;
    for (const double z : inner_cuts(whole)) {
      layers.push_back(slice(whole, from, z));
      from = z;
    }
    layers.push_back(slice(whole, from, whole.bottom));
  }
  for (Layer& layer : layers) layer.evenly_bent = is_evenly_bent(layer);
  // Neighbours share the speed at their common depth to the last bit.
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) layers[i + 1].c_top = layers[i].c_bottom;
  return layers;
}

double cut_at(std::vector<Layer>& layers, double depth) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (std::abs(depth - layers[i].top) <= same_depth) return layers[i].top;
    if (std::abs(depth - layers[i].bottom) <= same_depth) return layers[i].bottom;
    if (depth < layers[i].top || depth > layers[i].bottom) continue;
    const Layer lower = slice(layers[i], depth, layers[i].bottom);
    layers[i] = slice(layers[i], layers[i].top, depth);
    layers[i].c_bottom = lower.c_top;
    layers.insert(layers.begin() + static_cast<std::ptrdiff_t>(i) + 1, lower);
    return depth;
  }
  return depth;
}

}  // namespace asdic::detail
