// Part of layered_crossings.h: the way of a ray from layer to layer.
#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "raytrace/beams/arc.h"
#include "raytrace/beams/layered_crossings.h"

// A ray from layer to layer: what LayeredCrossings knows of it before it looks at columns.
namespace asdic::detail {
namespace {

/// A ray that passes more layers than this is trapped, as TraceLimits::max_segments has it:
/// launched within 1e-6 rad or so of the level of a kink (LevelRays), it would fill the memory.
constexpr std::size_t most_passes = 1'000'000;

}  // namespace

/// Each layer once: sin θ at its nodes, the range and time it takes to pass it, what p/ξ loses per
/// q where its gradient ends. Where ξc > 1 the ray does not come; the numbers there are not used.
/// \return every arc within a layer has |w|² below series_limit
bool LayeredCrossings::pass_layers(double xi, Workspace& work) const {
  const double xi2 = xi * xi;
  const std::size_t layers = gradient_.size(), nodes = depth_.size();
  work.sine.resize(nodes), work.jump.resize(nodes);
  work.reach.resize(layers), work.time.resize(layers);
  double *s_at = work.sine.data(), *jump = work.jump.data();
  double *layer_reach = work.reach.data(), *layer_time_at = work.time.data();
  const double *c_at = speed_.data(), *z_at = depth_.data(), *g_at = gradient_.data();
  for (std::size_t i = 0; i < nodes; ++i)
    s_at[i] = std::sqrt(std::max(0.0, 1.0 - xi2 * c_at[i] * c_at[i]));
  std::int64_t steep = 0, bent = 0;
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < layers; ++i) {
    const double a = s_at[i], b = s_at[i + 1];
    const double reach = xi * (c_at[i] + c_at[i + 1]) * (z_at[i + 1] - z_at[i]) / (a + b + 1e-30);
    const double w_over_g = xi * reach / (1.0 - a * b), w = w_over_g * g_at[i];
    layer_reach[i] = reach;
    layer_time_at[i] = w_over_g * atanh_over_w(w * w);
    const bool passed = a * b > 0.0;
    steep += (passed & (w * w >= series_limit)) ? 1 : 0;
    // (1 − s·s_a)² ≥ (1 − s²)(1 − s_a²) all along the arc
    const bool far = (a - b) * (a - b) >= series_limit * (1.0 - a * a) * (1.0 - b * b);
    bent += (passed & far) ? 1 : 0;
  }
  ASDIC_INDEPENDENT
  for (std::size_t i = 1; i < layers; ++i) jump[i] = (g_at[i] - g_at[i - 1]) * xi / s_at[i];
  if (steep > 0)
    for (std::size_t i = 0; i < layers; ++i)
      layer_time_at[i] = layer_time(xi * layer_reach[i] / (1.0 - s_at[i] * s_at[i + 1]), g_at[i]);
  return bent == 0;
}

/// The ray where it enters each layer, as far as the last column or as it can be received.
void LayeredCrossings::follow(double sine, double xi, Workspace& work) const {
  const std::size_t layers = gradient_.size();
  const double *s_at = work.sine.data(), *speed = speed_.data(), *depth = depth_.data();
  const double last_range = ranges_.empty() ? -1.0 : ranges_.back();
  std::complex<double> coefficient[2];  // of surface and bottom, once they are met
  double loss[2] = {-1.0, -1.0}, turn[2] = {0.0, 0.0};
  Piece now{.pass = 0};
  work.piece.assign(1, now);
  std::size_t layer = first_layer(sine), passes = 0;
  Pass at{.r = 0.0,
          .s = sine,
          .z = source_depth_,
          .cosine = xi * source_speed_,
          .tau = 0.0,
          .q = 0.0,
          .rate = 1.0 / (xi * source_speed_),
          .bend = 0.0,
          .length = 0.0};
  bool inside = !source_on_node_;  // the first layer is entered from within
  while (at.r <= last_range && passes < most_passes) {
    const double g = gradient_[layer];
    at.bend = xi * g;
    if (passes == work.pass.size()) work.pass.resize(2 * passes + 64);
    work.pass[passes++] = at;
    const bool down = at.s > 0.0;
    const std::size_t exit_node = down ? layer + 1 : layer;
    const bool cycles = xi * speed[exit_node] >= 1.0 || s_at[exit_node] == 0.0;
    std::size_t node = exit_node;
    double reach = work.reach[layer], time = work.time[layer],
           s_end = down ? s_at[node] : -s_at[node];
    if (cycles) {  // and leaves through the node by which it came, or lies on that side
      node = down ? layer : layer + 1;
      s_end = down ? -s_at[node] : s_at[node];
      reach = (at.s - s_end) / at.bend;
      work.flat &= (at.s - s_end) * (at.s - s_end) <
                   series_limit * (1.0 - at.s * at.s) * (1.0 - s_end * s_end);
    } else if (inside) {
      reach = (depth[node] - at.z) * (at.cosine + xi * speed[node]) / (at.s + s_end);
    }
    if (cycles || inside) time = layer_time(xi * reach / (1.0 - at.s * s_end), g);
    inside = false;
    if (alpha_ != 0.0) {
      const double dz = depth[node] - at.z, chord = std::sqrt(reach * reach + dz * dz);
      const double y = 0.5 * chord * at.bend;
      at.length += chord * (y * y < 0.05 ? asin_series(y) : std::asin(y) / y);
    }
    // The layer's end, and what happens there.
    at.r += reach;
    at.tau += time;
    at.q += at.rate * reach;
    at.z = depth[node];
    at.cosine = xi * speed[node];
    at.s = s_end;
    const bool caustic = at.q * now.sense < 0.0;
    if (caustic) now.sense = -now.sense, now.phase += 0.5 * pi;
    const bool at_surface = node == 0 && s_end < 0.0, at_bottom = node == layers && s_end > 0.0;
    if (at_surface || at_bottom) {
      const int which = at_surface ? 0 : 1;
      if (loss[which] < 0.0) {
        const Boundary& wall = at_surface ? environment_->surface : environment_->bottom;
        coefficient[which] =
            reflection_coefficient(wall.material, std::asin(std::abs(s_end)),
                                   {.speed = speed[node],
                                    .density = environment_->water_density.at(at.z),
                                    .frequency = frequency_});
        loss[which] = std::abs(coefficient[which]);
        turn[which] = std::arg(coefficient[which]);
      }
      now.level *= loss[which];
      now.phase += turn[which];
      now.mirror = -now.mirror;
      at.rate += 2.0 * at.bend * at.q / s_end;
      at.s = -s_end;
    } else {
      at.rate -= at.q * work.jump[node];  // either way: g's jump and sin θ change sign together
      layer = s_end > 0.0 ? node : node - 1;
    }
    if (caustic || at_surface || at_bottom) {
      now.pass = passes;
      work.piece.push_back(now);
      if (now.level == 0.0 || now.level < faintest_) break;
    }
  }
  work.pass.resize(std::max(work.pass.size(), passes + 1));
  work.pass[passes] = at;
  work.passes = passes;
}

}  // namespace asdic::detail
