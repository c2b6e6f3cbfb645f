#include "raytrace/layered/column.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

/// Walks from node `from` (the top of layer `from`) down to the bottom vertex, or up to the top
/// vertex, calling crossing(layer, sine_top, sine_bottom) and turning(layer, sine). \return whether
/// the vertex is a turning point
template <bool down, class Crossing, class Turning>
bool walk(const std::vector<Layer>& layers, std::size_t from, const RayParameter& ray,
          Crossing&& crossing, Turning&& turning) {
  const std::size_t count = down ? layers.size() - from : from;
  if (count == 0) return false;
  const Layer* layer = layers.data() + (down ? from : from - 1);
  double near = std::sqrt(std::max(ray.sine2(down ? layer->c_top : layer->c_bottom), 1e-300));
  for (std::size_t i = 0; i < count; ++i, down ? ++layer : --layer) {
    const double far2 = ray.sine2(down ? layer->c_bottom : layer->c_top);
    if (far2 <= 0.0) {
      turning(*layer, near);
      return true;
    }
    const double far = std::sqrt(far2);
    down ? crossing(*layer, near, far) : crossing(*layer, far, near);
    near = far;
  }
  return false;
}

template <class Crossing>
void walk_between(const std::vector<Layer>& layers, std::size_t upper, std::size_t lower,
                  const RayParameter& ray, Crossing&& crossing) {
  for (std::size_t i = upper; i < lower; ++i) {
    const double top = std::sqrt(std::max(ray.sine2(layers[i].c_top), 1e-300));
    crossing(layers[i], top, std::sqrt(std::max(ray.sine2(layers[i].c_bottom), 1e-300)));
  }
}

std::size_t node_at(const std::vector<Layer>& layers, double depth) {
  std::size_t i = 0;
  while (i < layers.size() && layers[i].top < depth) ++i;
  return i;
}

}  // namespace

Column::Column(std::span<const Layer> water, double source_depth, double receiver_depth)
    : layers_(water.begin(), water.end()), source_is_upper_(source_depth <= receiver_depth) {
  source_depth = cut_at(layers_, source_depth);
  receiver_depth = cut_at(layers_, receiver_depth);
  upper_ = node_at(layers_, std::min(source_depth, receiver_depth));
  lower_ = node_at(layers_, std::max(source_depth, receiver_depth));
  const auto speed_at = [&](std::size_t node) {
    return node < layers_.size() ? layers_[node].c_top : layers_.back().c_bottom;
  };
  source_speed_ = speed_at(source_is_upper_ ? upper_ : lower_);
  receiver_speed_ = speed_at(source_is_upper_ ? lower_ : upper_);
}

double Column::barrier_speed() const noexcept {
  double fastest = std::max(source_speed_, receiver_speed_);
  for (std::size_t i = upper_; i < lower_; ++i)
    fastest = std::max({fastest, layers_[i].c_top, layers_[i].c_bottom});
  return fastest;
}

double Column::least_crossing_time() const noexcept {
  double fastest = 0.0;
  for (const Layer& layer : layers_) fastest = std::max({fastest, layer.c_top, layer.c_bottom});
  return (layers_.back().bottom - layers_.front().top) / fastest;
}

ColumnSums Column::sums(const RayParameter& ray) const noexcept {
  ColumnSums sums;
  const auto into = [&ray](Pass& total) {
    return [&ray, &total](const Layer& layer, double top, double bottom) {
      total += layer.law == Layer::Law::c_linear ? cross_c_linear(layer, ray, top, bottom)
                                                 : cross(layer, ray, top, bottom);
    };
  };
  const auto turned = [&ray](Pass& total) {
    return [&ray, &total](const Layer& layer, double sine) { total += turn(layer, ray, sine); };
  };
  walk_between(layers_, upper_, lower_, ray, into(sums.middle));
  sums.turns_above = walk<false>(layers_, upper_, ray, into(sums.up), turned(sums.up));
  sums.turns_below = walk<true>(layers_, lower_, ray, into(sums.down), turned(sums.down));
  return sums;
}

ColumnDetails Column::details(const RayParameter& ray) const noexcept {
  ColumnDetails details;
  const auto into = [&ray](PassDetail& total) {
    return [&ray, &total](const Layer& layer, double top, double bottom) {
      total += cross_detail(layer, ray, top, bottom);
    };
  };
  const auto turned = [&ray](PassDetail& total) {
    return
        [&ray, &total](const Layer& layer, double sine) { total += turn_detail(layer, ray, sine); };
  };
  walk_between(layers_, upper_, lower_, ray, into(details.middle));
  walk<false>(layers_, upper_, ray, into(details.up), turned(details.up));
  walk<true>(layers_, lower_, ray, into(details.down), turned(details.down));
  return details;
}

Column::All Column::all(const RayParameter& ray) const noexcept {
  All all;
  const auto crossed = [&ray](Pass& pass, PassDetail& detail) {
    return [&ray, &pass, &detail](const Layer& layer, double top, double bottom) {
      pass += layer.law == Layer::Law::c_linear ? cross_c_linear(layer, ray, top, bottom)
                                                : cross(layer, ray, top, bottom);
      detail += cross_detail(layer, ray, top, bottom);
    };
  };
  const auto turned = [&ray](Pass& pass, PassDetail& detail) {
    return [&ray, &pass, &detail](const Layer& layer, double sine) {
      pass += turn(layer, ray, sine);
      detail += turn_detail(layer, ray, sine);
    };
  };
  ColumnSums& s = all.sums;
  ColumnDetails& d = all.details;
  walk_between(layers_, upper_, lower_, ray, crossed(s.middle, d.middle));
  s.turns_above = walk<false>(layers_, upper_, ray, crossed(s.up, d.up), turned(s.up, d.up));
  s.turns_below = walk<true>(layers_, lower_, ray, crossed(s.down, d.down), turned(s.down, d.down));
  return all;
}

}  // namespace asdic::detail
