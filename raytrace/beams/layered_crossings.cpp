#include "raytrace/beams/layered_crossings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raytrace/beams/lanes.h"
#include "raytrace/layered/lane_math.h"

namespace asdic {

namespace {

/// atanh(w)/w as a function of w²: a series to 5e-11 where w² < 0.1.
inline double atanh_over_w(double w2) noexcept {
  return 1.0 +
         w2 * (1.0 / 3 +
               w2 * (1.0 / 5 +
                     w2 * (1.0 / 7 +
                           w2 * (1.0 / 9 +
                                 w2 * (1.0 / 11 +
                                       w2 * (1.0 / 13 + w2 * (1.0 / 15 + w2 * (1.0 / 17))))))));
}
constexpr double series_limit = 0.1;

/// The same number into the next few places.
using Doubles = std::experimental::native_simd<double>;
constexpr std::size_t doubles = Doubles::size();
inline void fill(double value, double* to) noexcept {
  Doubles(value).copy_to(to, std::experimental::element_aligned);
}

/// τ over a range Δ within one layer. \param w_over_g  ξΔ/(1 − s_a·s_b)
inline double layer_time(double w_over_g, double g) noexcept {
  const double w = w_over_g * g;
  return w * w < series_limit ? w_over_g * atanh_over_w(w * w) : std::atanh(w) / g;
}

/// asin(y)/y for |y| < 0.3 or so, y half the angle by which the ray turns.
inline double asin_over_y(double y2) noexcept {
  return 1.0 + y2 * (1.0 / 6 + y2 * (3.0 / 40 + y2 * (15.0 / 336 + y2 * (105.0 / 3456))));
}

}  // namespace

std::optional<LayeredCrossings> LayeredCrossings::make(const Environment& environment,
                                                       double frequency, double source_depth,
                                                       std::span<const double> ranges,
                                                       const TraceLimits& limits) {
  const SoundSpeedProfile& water = environment.water;
  const DepthFunction alpha = attenuation_np_per_m(environment, frequency);
  const bool c_linear =
      !water.munk_parameters() &&
      (water.interpolation() == Interpolation::c_linear || water.depths().size() == 1);
  const double top = environment.surface.depth, bottom = environment.bottom.depth;
  const bool rough =
      !environment.surface.roughness.smooth() || !environment.bottom.roughness.smooth();
  if (!c_linear || rough || environment.section || environment.surface.shape ||
      environment.bottom.shape || !alpha.is_constant() || limits.max_depth <= bottom ||
      ranges.front() < 0.0 || !(source_depth > top && source_depth < bottom))
    return std::nullopt;
  constexpr double same_line = 1e-7;  // [m]
  LayeredCrossings result;
  result.environment_ = &environment;
  result.ranges_ = ranges.first(static_cast<std::size_t>(
      std::lower_bound(ranges.begin(), ranges.end(), limits.max_range) - ranges.begin()));
  result.alpha_ = alpha.at(0.0);
  result.faintest_ = limits.faintest;
  result.depth_.push_back(top);
  for (const double z : water.depths())
    if (z > top + same_line && z < bottom - same_line) result.depth_.push_back(z);
  result.depth_.push_back(bottom);
  for (const double z : result.depth_) result.speed_.push_back(water.at(z).c);
  for (std::size_t i = 0; i + 1 < result.depth_.size(); ++i)
    result.gradient_.push_back((result.speed_[i + 1] - result.speed_[i]) /
                               (result.depth_[i + 1] - result.depth_[i]));
  result.source_depth_ = source_depth;
  result.source_speed_ = water.at(source_depth).c;
  const auto below = std::upper_bound(result.depth_.begin(), result.depth_.end(), source_depth);
  result.source_layer_ = static_cast<std::size_t>(below - result.depth_.begin()) - 1;
  result.source_on_node_ = result.depth_[result.source_layer_] == source_depth;
  return result;
}

std::size_t LayeredCrossings::first_layer(double sine) const noexcept {
  return source_on_node_ && sine < 0.0 ? source_layer_ - 1 : source_layer_;
}

/// exp(−∫α ds): the last layer's arc is its chord times asin(y)/y.
void LayeredCrossings::absorb(double xi, std::size_t n, Workspace& work, Crossings& out) const {
  const double *ranges = ranges_.data(), *r_a = work.r.data(), *z_a = work.z.data(),
               *g_a = work.g.data(), *depth = out.depth.data();
  double* length = work.length.data();
  ASDIC_INDEPENDENT
  for (std::size_t j = 0; j < n; ++j) {
    const double d = ranges[j] - r_a[j], dz = depth[j] - z_a[j];
    const double chord = std::sqrt(d * d + dz * dz), y = 0.5 * chord * xi * g_a[j];
    length[j] += chord * asin_over_y(y * y);
  }
  for (std::size_t j = 0; j < n; j += doubles) {  // beyond n there is room
    const Rays nepers = min(alpha_ * load(length + j), Rays(700.0));
    store(load(&out.level[j]) * exponential(-nepers), &out.level[j]);
  }
}

bool LayeredCrossings::find(double launch_elevation, Workspace& work, Crossings& out) const {
  const double cosine = std::cos(launch_elevation), sine = -std::sin(launch_elevation);
  if (!(cosine > 1e-3) || std::abs(sine) < 1e-9) return false;
  const double xi = cosine / source_speed_, xi2 = xi * xi, slow = 1.0 / xi;
  const std::size_t layers = gradient_.size(), nodes = depth_.size(), columns = ranges_.size();

  // Each layer once: sin θ at its nodes, the range and time it takes to pass it. Where ξc > 1 the
  // ray does not come; the numbers there are not used.
  work.sine.resize(nodes), work.reach.resize(layers), work.time.resize(layers);
  double* s_at = work.sine.data();
  for (std::size_t i = 0; i < nodes; ++i)
    s_at[i] = std::sqrt(std::max(0.0, 1.0 - xi2 * speed_[i] * speed_[i]));
  double *layer_reach = work.reach.data(), *layer_time_at = work.time.data();
  const double *c_at = speed_.data(), *z_at = depth_.data(), *g_at = gradient_.data();
  std::int64_t steep = 0;
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < layers; ++i) {
    const double a = s_at[i], b = s_at[i + 1];
    const double reach = xi * (c_at[i] + c_at[i + 1]) * (z_at[i + 1] - z_at[i]) / (a + b + 1e-30);
    const double w_over_g = xi * reach / (1.0 - a * b), w = w_over_g * g_at[i];
    layer_reach[i] = reach;
    layer_time_at[i] = w_over_g * atanh_over_w(w * w);
    steep += w * w * (a * b > 0.0 ? 1.0 : 0.0) >= series_limit ? 1 : 0;
  }
  work.jump.resize(nodes);
  double* jump = work.jump.data();
  ASDIC_INDEPENDENT
  for (std::size_t i = 1; i < layers; ++i) jump[i] = (g_at[i] - g_at[i - 1]) * xi2 / s_at[i];
  if (steep > 0)
    for (std::size_t i = 0; i < layers; ++i)
      work.time[i] = layer_time(xi * work.reach[i] / (1.0 - s_at[i] * s_at[i + 1]), gradient_[i]);

  for (auto* array : {&work.r, &work.s, &work.z, &work.cosine, &work.tau, &work.q, &work.p, &work.g,
                      &work.length})
    array->resize(columns + doubles);
  out.resize(columns + doubles);
  out.source_speed = source_speed_;
  double *r_to = work.r.data(), *s_to = work.s.data(), *z_to = work.z.data(),
         *cos_to = work.cosine.data(), *tau_to = work.tau.data(), *q_to = work.q.data(),
         *p_to = work.p.data(), *g_to = work.g.data(), *level_to = out.level.data(),
         *phase_to = out.phase.data(), *mirror_to = out.mirror.data();

  std::complex<double> coefficient[2];  // of surface and bottom, once they are met
  double loss[2] = {-1.0, -1.0}, turn[2] = {0.0, 0.0};
  double level = 1.0, phase = 0.0, mirror = 1.0, sense = 1.0, length = 0.0;
  bool flat_series = true;
  // Where the ray enters a layer.
  std::size_t layer = first_layer(sine), column = 0;
  double r = 0.0, tau = 0.0, q = 0.0, p = 1.0 / source_speed_, s = sine, z = source_depth_,
         cos_a = cosine;
  bool inside = !(source_on_node_);  // the first layer is entered from within
  while (column < columns) {
    const double g = gradient_[layer];
    const bool down = s > 0.0;
    const std::size_t exit_node = down ? layer + 1 : layer;
    const bool turns = xi * speed_[exit_node] >= 1.0 || s_at[exit_node] == 0.0;
    double reach, time, s_end;
    std::size_t node;
    if (turns) {  // and leaves through the node by which it came, or lies on that side
      node = down ? layer : layer + 1;
      s_end = down ? -s_at[node] : s_at[node];
      reach = (s - s_end) / (xi * g);
      time = layer_time(xi * reach / (1.0 - s * s_end), g);
    } else {
      node = exit_node;
      s_end = down ? s_at[node] : -s_at[node];
      if (inside) {
        const double cos_end = xi * speed_[node];
        reach = (depth_[node] - z) * (cos_a + cos_end) / (s + s_end);
        time = layer_time(xi * reach / (1.0 - s * s_end), g);
      } else {
        reach = work.reach[layer];
        time = work.time[layer];
      }
    }
    inside = false;
    const double r_end = r + reach;
    if (column < columns && ranges_[column] < r_end) {
      flat_series &=
          xi2 * g * g * reach * reach < series_limit * (1.0 - s * s) * (1.0 - s_end * s_end);
      const std::size_t first = column;
      while (column < columns && ranges_[column] < r_end) ++column;
      // four at a time; what is written too many is overwritten by the layers to come
      for (std::size_t j = first; j < column; j += doubles) {
        fill(r, r_to + j), fill(s, s_to + j), fill(z, z_to + j), fill(cos_a, cos_to + j);
        fill(tau, tau_to + j), fill(q, q_to + j), fill(p, p_to + j), fill(g, g_to + j);
        fill(level, level_to + j), fill(phase, phase_to + j), fill(mirror, mirror_to + j);
      }
      if (alpha_ != 0.0)
        for (std::size_t j = first; j < column; j += doubles) fill(length, work.length.data() + j);
    }
    if (alpha_ != 0.0) {
      const double dz = depth_[node] - z, chord = std::sqrt(reach * reach + dz * dz);
      const double y = 0.5 * chord * xi * g;
      length += chord * (y * y < 0.05 ? asin_over_y(y * y) : std::asin(y) / y);
    }
    // The layer's end, and what happens there.
    r = r_end;
    tau += time;
    q += p * (reach * slow);
    if (q * sense < 0.0) {
      sense = -sense;
      phase += 0.5 * pi;
    }
    z = depth_[node];
    cos_a = xi * speed_[node];
    s = s_end;
    const bool at_surface = node == 0 && s < 0.0, at_bottom = node == layers && s > 0.0;
    if (at_surface || at_bottom) {
      const int which = at_surface ? 0 : 1;
      if (loss[which] < 0.0) {
        const Boundary& wall = at_surface ? environment_->surface : environment_->bottom;
        coefficient[which] = reflection_coefficient(
            wall.material, std::asin(std::abs(s)),
            {.speed = speed_[node], .density = environment_->water_density.at(z)});
        loss[which] = std::abs(coefficient[which]);
        turn[which] = std::arg(coefficient[which]);
      }
      level *= loss[which];
      phase += turn[which];
      mirror = -mirror;
      p += 2.0 * g * xi2 * q / s;
      s = -s;
      if (level == 0.0 || level < faintest_) break;
      continue;
    }
    p -= q * jump[node];  // either way: g's jump and sin θ change sign together
    layer = s > 0.0 ? node : node - 1;
  }

  // All crossings at once.
  const std::size_t n = column;
  const double *ranges = ranges_.data(), *r_a = work.r.data(), *s_a = work.s.data(),
               *z_a = work.z.data(), *c_a = work.cosine.data(), *t_a = work.tau.data(),
               *q_a = work.q.data(), *p_a = work.p.data(), *g_a = work.g.data();
  double *depth = out.depth.data(), *cos_out = out.cosine.data(), *sine_out = out.sine.data(),
         *speed = out.speed.data(), *time = out.time.data(), *q_out = out.q.data(),
         *dq = out.dq_ds.data(), *phase_out = out.phase.data();
  ASDIC_INDEPENDENT
  for (std::size_t j = 0; j < n; ++j) {
    const double d = ranges[j] - r_a[j], bend = xi * g_a[j];
    const double s_j = s_a[j] - bend * d;
    const double cos_j = std::sqrt(1.0 - s_j * s_j);
    const double chord = c_a[j] + cos_j, arc = 1.0 - s_a[j] * s_j, both = d / (chord * arc);
    depth[j] = z_a[j] + (s_a[j] + s_j) * arc * both;  // Δ(sin θ_a + sin θ)/(cos θ_a + cos θ)
    const double w_over_g = xi * chord * both, w = w_over_g * g_a[j];
    time[j] = t_a[j] + w_over_g * atanh_over_w(w * w);
    q_out[j] = q_a[j] + p_a[j] * d * slow;
    cos_out[j] = cos_j;
    sine_out[j] = s_j;
    speed[j] = cos_j * slow;
    dq[j] = speed[j] * p_a[j];
    phase_out[j] += q_a[j] * q_out[j] < 0.0 ? 0.5 * pi : 0.0;
  }
  if (!flat_series)
    for (std::size_t j = 0; j < n; ++j) {
      const double d = ranges[j] - r_a[j];
      time[j] = t_a[j] + layer_time(xi * d / (1.0 - s_a[j] * sine_out[j]), g_a[j]);
    }
  if (alpha_ != 0.0) absorb(xi, n, work, out);
  out.resize(n);
  std::iota(out.column.begin(), out.column.end(), 0U);
  return true;
}

}  // namespace asdic
