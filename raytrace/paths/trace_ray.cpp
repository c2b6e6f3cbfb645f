#include "raytrace/paths/trace_ray.h"

#include <algorithm>
#include <cmath>

#include "raytrace/layered/layer.h"
#include "raytrace/layered/layer_pass.h"
#include "raytrace/layered/ray_parameter.h"
#include "raytrace/paths/drawn_path.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {
namespace {

constexpr int most_segments = 40'000;  // of a marched ray: 30 MB

/// Walks one ray from layer to layer, a thin slice at a time.
class RayWalker {
  static constexpr int most_turns = 20000;

 public:
  RayWalker(const Environment& environment, double source_depth, double elevation,
            double depth_step)
      : layers_(
            make_layers(environment.water, environment.surface.depth, environment.bottom.depth)),
        depth_(source_depth),
        down_(elevation < 0.0) {
    source_depth = cut_at(layers_, source_depth);
    // Thin slices everywhere: each is crossed or turned in by the exact sums.
    for (double z = environment.surface.depth + depth_step; z < environment.bottom.depth;
         z += depth_step)
      cut_at(layers_, z);
    index_ = 0;
    while (index_ < layers_.size() && layers_[index_].top < source_depth)
      ++index_;  // the layer below the source
    const double c = index_ < layers_.size() ? layers_[index_].c_top : layers_.back().c_bottom;
    ray_ = RayParameter(c, std::max(std::abs(std::sin(elevation)), 1e-9));
    path_.launch_elevation = elevation;
    add();
  }

  RayPath walk(double max_range, int max_bounces) {
    limit_ = max_range;
    if (runs_along_a_minimum()) return straight(max_range);
    while (range_ < max_range && path_.surface_bounces + path_.bottom_bounces <= max_bounces &&
           path_.turns < most_turns) {
      if (down_ ? index_ == layers_.size() : index_ == 0) {
        bounce();
        continue;
      }
      const Layer& layer = layers_[down_ ? index_ : index_ - 1];
      const double near =
          std::sqrt(std::max(ray_.sine2(down_ ? layer.c_top : layer.c_bottom), 1e-300));
      const double far2 = ray_.sine2(down_ ? layer.c_bottom : layer.c_top);
      if (far2 > 0.0)
        cross_layer(layer, near, std::sqrt(far2));
      else
        turn_in_layer(layer, near);
    }
    const double c = speed_here();
    path_.final_elevation =
        (down_ ? -1.0 : 1.0) * std::acos(std::clamp(ray_.slowness * c, -1.0, 1.0));
    return std::move(path_);
  }

 private:
  /// A horizontal ray at a depth that is not faster than the water on either side stays there.
  bool runs_along_a_minimum() const {
    if (ray_.sigma > 1e-6) return false;
    const bool above = index_ == 0 || layers_[index_ - 1].c_top >= layers_[index_ - 1].c_bottom;
    const bool below =
        index_ == layers_.size() || layers_[index_].c_bottom >= layers_[index_].c_top;
    return above && below;
  }

  RayPath straight(double max_range) {
    range_ = path_.path_length = max_range;
    time_ = max_range * ray_.slowness;
    add();
    path_.final_elevation = path_.launch_elevation;
    return std::move(path_);
  }

  void add() { path_.points.push_back({range_, depth_, time_}); }

  struct Way {
    double range = 0.0, time = 0.0, length = 0.0;
  };

  /// From an edge of the layer to a depth inside it that the ray reaches.
  Way way(const Layer& layer, double edge, double depth) const {
    if (std::abs(depth - edge) < same_depth) return {};  // cut_at would not cut there
    std::vector<Layer> parts = {layer};
    depth = cut_at(parts, depth);
    const Layer& part = edge < depth ? parts.front() : parts.back();
    const double top = std::sqrt(std::max(ray_.sine2(part.c_top), 1e-300));
    const double bottom = std::sqrt(std::max(ray_.sine2(part.c_bottom), 1e-300));
    const Pass pass = cross(part, ray_, top, bottom);
    const PassDetail detail = cross_detail(part, ray_, top, bottom);
    return {pass.range, detail.time, detail.length};
  }

  /// Ends the ray at `limit_` if that lies within the way from `edge` to `far` (there, or back from
  /// it), at the exact depth.
  bool ends_within(const Layer& layer, double edge, double far, const Way& total, bool back) {
    if (range_ + total.range < limit_) return false;
    double low = 0.0, high = 1.0;  // share of the depth
    Way at;
    for (int i = 0; i < 60; ++i) {
      const double share = 0.5 * (low + high);
      depth_ = edge + share * (far - edge);
      at = share > 0.0 ? way(layer, edge, depth_) : Way{};
      if (back) at = {total.range - at.range, total.time - at.time, total.length - at.length};
      ((range_ + at.range < limit_) != back ? low : high) = share;
    }
    range_ = limit_;
    time_ += at.time;
    path_.path_length += at.length;
    add();
    return true;
  }

  void step(const Way& way) {
    range_ += way.range;
    time_ += way.time;
    path_.path_length += way.length;
  }

  void cross_layer(const Layer& layer, double near, double far) {
    const double top = down_ ? near : far, bottom = down_ ? far : near;
    const Pass pass = cross(layer, ray_, top, bottom);
    const PassDetail detail = cross_detail(layer, ray_, top, bottom);
    const double edge = down_ ? layer.top : layer.bottom, other = down_ ? layer.bottom : layer.top;
    const Way total{pass.range, detail.time, detail.length};
    if (ends_within(layer, edge, other, total, false)) return;
    step(total);
    depth_ = other;
    down_ ? ++index_ : --index_;
    add();
  }

  /// In and out again, with points that lie closer where the ray flattens.
  void turn_in_layer(const Layer& layer, double near) {
    constexpr int points = 6;
    const Pass pass = turn(layer, ray_, near);
    const PassDetail detail = turn_detail(layer, ray_, near);
    const Way total{pass.range, detail.time, detail.length};
    const double edge = down_ ? layer.top : layer.bottom, vertex = turning_depth(layer, ray_);
    const double r0 = range_, t0 = time_;
    const auto depth_at = [&](int i) {
      return vertex + (edge - vertex) * (double(i) / points) * (double(i) / points);
    };
    for (int i = points - 1; i > 0 && r0 + total.range < limit_; --i) {
      const Way at = way(layer, edge, depth_at(i));
      path_.points.push_back({r0 + at.range, depth_at(i), t0 + at.time});
    }
    if (ends_within(layer, edge, vertex, total, false)) return;
    step(total);
    depth_ = vertex;
    down_ = !down_;
    ++path_.turns;
    add();
    const double r1 = range_, t1 = time_;
    if (ends_within(layer, edge, vertex, total, true)) return;
    for (int i = 1; i < points; ++i) {
      const Way at = way(layer, edge, depth_at(i));
      path_.points.push_back({r1 + total.range - at.range, depth_at(i), t1 + total.time - at.time});
    }
    step(total);
    depth_ = edge;
    add();
  }

  void bounce() {
    if (down_) {
      ++path_.bottom_bounces;
    } else {
      ++path_.surface_bounces;
      path_.surface_hits.push_back(range_);
    }
    down_ = !down_;
  }

  double speed_here() const {
    const std::size_t i = std::min(index_, layers_.size() - 1);
    return layers_[i].at(path_.points.back().depth).c;
  }

  std::vector<Layer> layers_;
  RayParameter ray_{1500.0, 1.0};
  RayPath path_;
  double depth_, range_ = 0.0, time_ = 0.0, limit_ = 0.0;
  bool down_;
  std::size_t index_ = 0;  // of the layer whose top is the present depth
};

/// In an ocean that is not layered.
RayPath marched(const Environment& environment, double source_depth, double launch_elevation,
                double max_range, double depth_step, int max_bounces) {
  constexpr double any_frequency = 1000.0;  // losses are not drawn
  constexpr double sagitta = 0.5;
  const RayTracer tracer(environment, any_frequency);
  RayTrajectory ray;
  tracer.trace(0.0, source_depth, launch_elevation,
               {.min_range = -max_range,
                .max_range = max_range,
                .max_surface_bounces = max_bounces,
                .max_bottom_bounces = max_bounces,
                .max_segments = most_segments},
               ray);
  double length = 1e300;
  for (const RaySegment& s : ray.segments) {
    if (s.history.surface_bounces + s.history.bottom_bounces <= max_bounces) continue;
    length = s.begin.length;
    break;
  }
  return drawn_path(ray, length, sagitta, depth_step);
}

}  // namespace

RayPath trace_ray(const Environment& environment, double source_depth, double launch_elevation,
                  double max_range, double depth_step, int max_bounces) {
  if (!is_layered(environment)) {
    return marched(environment, source_depth, launch_elevation, max_range, depth_step, max_bounces);
  }
  return RayWalker(environment, source_depth, launch_elevation, depth_step)
      .walk(max_range, max_bounces);
}

}  // namespace asdic::detail
