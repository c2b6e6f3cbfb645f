#include "raytrace/layered/layered_fan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace asdic::detail {

std::optional<LayeredFan> LayeredFan::make(const Environment& environment, double frequency,
                                           double source_depth) {
  const double top = environment.surface.depth, bottom = environment.bottom.depth;
  if (!is_layered(environment) || !(source_depth > top && source_depth < bottom))
    return std::nullopt;
  const std::vector<Layer> layers = make_layers(environment.water, top, bottom);
  for (const Layer& layer : layers)
    if (layer.law != Layer::Law::c_linear) return std::nullopt;
  return LayeredFan(environment, frequency,
                    std::make_shared<const Column>(layers, source_depth, source_depth));
}

LayeredFan::LayeredFan(const Environment& environment, double frequency,
                       std::shared_ptr<const Column> column)
    : column_(std::move(column)),
      builder_(environment, *column_, frequency),
      source_node_(column_->upper()),
      layers_(column_->layers().size()) {
  for (const Layer& layer : column_->layers()) {
    depth_.push_back(layer.top);
    speed_.push_back(layer.c_top);
    upper_.push_back(layer.c_top);
    lower_.push_back(layer.c_bottom);
    gradient_.push_back(layer.gradient);
    sum_h_.push_back((layer.c_top + layer.c_bottom) * layer.thickness());
  }
  depth_.push_back(column_->layers().back().bottom);
  speed_.push_back(column_->bottom_speed());
  for (auto* values : {&speed_, &upper_, &lower_, &gradient_, &sum_h_})
    values->resize(layers_ + 1 + rays_at_once, values->back());
}

/// Sines at the nodes, and ranges, their slopes and times through the layers. Where the ray does
/// not come, sines are zero and the rest is not used.
void LayeredFan::sum_layers(double xi, double sigma, Workspace& work) const noexcept {
  const double c0 = column_->source_speed(), per_c2 = 1.0 / (c0 * c0), sigma2 = sigma * sigma;
  const std::size_t padded = layers_ + 1 + rays_at_once;
  for (auto* values : {&work.sine, &work.reach, &work.d_range, &work.time}) values->resize(padded);
  for (std::size_t i = 0; i <= layers_; i += rays_at_once) {
    const Rays c = load(&speed_[i]);
    const Rays s2 = ((c0 - c) * (c0 + c) + sigma2 * (c * c)) * per_c2;
    store(sqrt(max(s2, Rays(0.0))), &work.sine[i]);
  }
  const double xi2 = xi * xi;
  for (std::size_t i = 0; i < layers_; i += rays_at_once) {
    const Rays a = load(&work.sine[i]), b = load(&work.sine[i + 1]), product = a * b;
    const Rays c_a2 = load(&upper_[i]) * load(&upper_[i]),
               c_b2 = load(&lower_[i]) * load(&lower_[i]);
    const Rays chord = load(&sum_h_[i]) / (a + b), d_range = chord / product;  // chord = r/ξ
    const Rays y = chord * (1.0 + product) / (c_a2 + c_b2 - xi2 * (c_a2 * c_b2));
    store(xi * chord, &work.reach[i]);
    store(d_range, &work.d_range[i]);
    store(y * atanh_over(load(&gradient_[i]) * y), &work.time[i]);
  }
}

/// r = s/(ξ|g|), ∂r/∂ξ = −1/(ξ²|g|s), τ = atanh(s)/|g|.
LayeredFan::Sum LayeredFan::turn(double xi, double sine, double gradient) const noexcept {
  const double g = std::abs(gradient), range = sine / (xi * g);
  return {range, -range / (xi * sine * sine), std::atanh(sine) / g};
}

bool LayeredFan::trace(double elevation, double range, Workspace& work,
                       RayAtRange& out) const noexcept {
  const double c0 = column_->source_speed();
  const double cosine = std::cos(elevation), s0 = std::abs(std::sin(elevation));
  if (!(cosine > 1e-3 && s0 > 1e-7 && range >= 0.0)) return false;
  const double xi = cosine / c0;
  sum_layers(xi, s0, work);

  // The vertices, and sums from the upper one down to each node that the ray comes to.
  std::size_t first = source_node_, last = source_node_;
  while (first > 0 && work.sine[first - 1] > 0.0) --first;
  while (last < layers_ && work.sine[last + 1] > 0.0) ++last;
  const bool turns_above = first > 0, turns_below = last < layers_;
  Sum sum = turns_above ? turn(xi, work.sine[first], gradient_[first - 1]) : Sum{};
  for (std::size_t i = first; i < last; ++i) {
    const Sum layer = {work.reach[i], work.d_range[i], work.time[i]};
    work.reach[i] = sum.range, work.d_range[i] = sum.d_range, work.time[i] = sum.time;
    sum = {sum.range + layer.range, sum.d_range + layer.d_range, sum.time + layer.time};
  }
  work.reach[last] = sum.range, work.d_range[last] = sum.d_range, work.time[last] = sum.time;
  const auto at = [&](std::size_t node) {
    return Sum{work.reach[node], work.d_range[node], work.time[node]};
  };
  if (turns_below) {
    const Sum end = turn(xi, work.sine[last], gradient_[last]);
    sum = {sum.range + end.range, sum.d_range + end.d_range, sum.time + end.time};
  }
  const Sum half = sum, source = at(source_node_);

  // Vertices passed, and the place below the upper vertex, x, of the ray's last half cycle.
  const bool up = elevation > 0.0;
  const double to_vertex = up ? source.range : half.range - source.range;
  int vertices = 0;
  double x = up ? source.range - range : source.range + range;
  bool down = !up;
  Sum before = up ? source : Sum{-source.range, -source.d_range, -source.time};
  if (range >= to_vertex) {
    const double halves = std::floor((range - to_vertex) / half.range);
    vertices = 1 + static_cast<int>(halves);
    down = up == (vertices % 2 == 1);
    const double beyond = range - to_vertex - halves * half.range;
    x = down ? beyond : half.range - beyond;
    // whole half cycles, the way to the first vertex, and of a rising ray one half cycle more, from
    // which the way from the upper vertex is taken
    const double more = halves + (up ? 0.0 : 1.0) + (down ? 0.0 : 1.0);
    const double sign = up ? 1.0 : -1.0;
    before = {0.0, sign * source.d_range + more * half.d_range,
              sign * source.time + more * half.time};
  }

  // In the layer of the node above that place, or of the vertex above the first node.
  const auto begin = work.reach.begin() + static_cast<std::ptrdiff_t>(first),
             end = work.reach.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  const auto beyond = static_cast<std::size_t>(std::upper_bound(begin, end, x) - begin);
  const std::size_t node = beyond == 0 ? first : first + beyond - 1;
  std::size_t layer = beyond == 0 ? (first > 0 ? first - 1 : 0) : node;
  if (layer == layers_) --layer;  // on the bottom
  const double g = gradient_[layer], s_a = work.sine[node], d = x - work.reach[node];
  const double s = std::max(s_a - xi * g * d, 0.0), cos_s = std::sqrt((1.0 - s) * (1.0 + s));
  const double way = down ? 1.0 : -1.0;
  const double w_over_g = xi * d / (1.0 - s_a * s), w = w_over_g * g;
  out.time = before.time +
             way * (work.time[node] +
                    w_over_g * (std::abs(w) < short_series ? atanh_series(w) : std::atanh(w) / w));
  out.depth = depth_[node] + d * (s_a + s) / (xi * speed_[node] + cos_s);
  out.elevation = std::atan2(down ? -s : s, cos_s);

  // q = ±(∂r/∂ξ)·s·s₀/c₀; in the last layer ∂r/∂ξ grows by Δ/(ξ·s_a·s). It changes sign where s
  // does, at a turning point.
  const int tops = up ? (vertices + 1) / 2 : vertices / 2, bottoms = vertices - tops;
  out.surface_bounces = turns_above ? 0 : tops;
  out.bottom_bounces = turns_below ? 0 : bottoms;
  const int turns = (turns_above ? tops : 0) + (turns_below ? bottoms : 0);
  const double until = before.d_range + way * work.d_range[node];
  const double spread = until * s + way * d / (xi * s_a);  // (∂r/∂ξ)·s
  const double sign = (turns % 2 == 0 ? 1.0 : -1.0) * s0 / c0;
  out.turns = turns;
  out.caustics = caustics_passed(turns, spread);
  out.q = sign * spread;
  out.p = sign * (1.0 / s_a - way * xi * xi * g * until);
  out.reflection =
      builder_.reflections(RayParameter(c0, s0), out.surface_bounces, out.bottom_bounces);
  out.arrived = out.reflection != 0.0;
  return true;
}

}  // namespace asdic::detail
