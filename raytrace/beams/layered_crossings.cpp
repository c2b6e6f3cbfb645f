#include "raytrace/beams/layered_crossings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/simd.h"
#include "raytrace/beams/arc.h"

namespace asdic::detail {

namespace {

using Doubles = SimdDoubles;
constexpr std::size_t doubles = doubles_at_once;

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
      limits.min_depth >= top || ranges.front() < 0.0 ||
      !(source_depth > top && source_depth < bottom))
    return std::nullopt;
  constexpr double same_line = 1e-7;  // [m]
  LayeredCrossings result;
  result.environment_ = &environment;
  result.ranges_ = ranges.first(static_cast<std::size_t>(
      std::lower_bound(ranges.begin(), ranges.end(), limits.max_range) - ranges.begin()));
  const std::size_t columns = result.ranges_.size();
  if (columns > 1) {
    const double step = (ranges[columns - 1] - ranges[0]) / static_cast<double>(columns - 1);
    bool even = step > 0.0;
    for (std::size_t j = 0; j < columns; ++j)
      even = even && std::abs(ranges[j] - (ranges[0] + static_cast<double>(j) * step)) < same_line;
    if (even) result.columns_per_metre_ = 1.0 / step;
  }
  result.padded_ranges_ = std::vector<double>(columns + doubles);
  std::copy_n(ranges.begin(), columns, result.padded_ranges_.begin());
  result.columns_ = std::vector<std::uint32_t>(columns);
  std::iota(result.columns_.begin(), result.columns_.end(), 0U);
  result.alpha_ = alpha.at(0.0);
  result.faintest_ = limits.faintest;
  result.frequency_ = frequency;
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

/// The first column from `column` on whose range is not below `range`. Evenly spaced ones may be
/// one off for rounding: an arc that goes on for a rounding error is the same ray.
inline std::size_t LayeredCrossings::column_at(double range, std::size_t column) const noexcept {
  const std::size_t columns = ranges_.size();
  if (columns_per_metre_ > 0.0) {
    const double place = std::ceil((range - ranges_.front()) * columns_per_metre_);
    const int end = static_cast<int>(std::min(static_cast<double>(columns), std::max(0.0, place)));
    return static_cast<std::size_t>(end);
  }
  while (column < columns && ranges_[column] < range) ++column;
  return column;
}

bool LayeredCrossings::find(double launch_elevation, Workspace& work, Crossings& out) const {
  const double cosine = std::cos(launch_elevation), sine = -std::sin(launch_elevation);
  if (!(cosine > 1e-3) || std::abs(sine) < 1e-9) return false;
  const double xi = cosine / source_speed_;
  work.flat = pass_layers(xi, work);
  follow(sine, xi, work);
  const std::size_t room = ranges_.size() + std::max(simd_width, doubles);
  work.pass_of.resize(room), work.length.resize(room);
  out.resize(room);
  const std::size_t n = find_layers(work);
  alpha_ == 0.0 ? cross<false>(xi, n, work, out) : cross<true>(xi, n, work, out);
  fill_pieces(n, work, out);
  out.resize(n);
  out.source_speed = source_speed_;
  std::copy_n(columns_.begin(), n, out.column.begin());
  return true;
}

/// In which layer the ray crosses each column. \return how many it crosses
std::size_t LayeredCrossings::find_layers(Workspace& work) const {
  std::size_t column = 0;
  std::int32_t* pass_of = work.pass_of.data();
  for (std::size_t k = 0; k < work.passes; ++k) {
    const std::size_t first = column;
    column = column_at(work.pass[k + 1].r, column);
    // as many at a time as most layers have; those too many are overwritten by the next
    for (std::size_t j = first; j < column; j += simd_width)
      store(SimdInts(static_cast<std::int32_t>(k)), pass_of + j);
  }
  for (std::size_t j = column; j < column + doubles; ++j) pass_of[j] = 0;  // read and not used
  return column;
}

/// All crossings, several at a time.
template <bool absorbing>
void LayeredCrossings::cross(double xi, std::size_t n, Workspace& work, Crossings& out) const {
  const Doubles slow = 1.0 / xi;
  double *depth = out.depth.data(), *cosine = out.cosine.data(), *sine = out.sine.data(),
         *speed = out.speed.data(), *time = out.time.data(), *q = out.q.data(),
         *dq_ds = out.dq_ds.data(), *length = work.length.data();
  const double* ranges = padded_ranges_.data();
  const std::int32_t* pass_of = work.pass_of.data();
  const Pass* passes = work.pass.data();
  for (std::size_t j = 0; j < n; j += doubles) {
    const auto of = [&](double Pass::*what) {
      return Doubles([&](auto l) { return passes[pass_of[j + l]].*what; });
    };
    const Doubles s_a = of(&Pass::s), bend = of(&Pass::bend), rate = of(&Pass::rate);
    const Doubles d = load(ranges + j) - of(&Pass::r);
    const Doubles s = s_a - bend * d, c = sqrt(1.0 - s * s);
    const Doubles chord = of(&Pass::cosine) + c, arc = 1.0 - s_a * s, both = d / (chord * arc);
    const Doubles dz = (s_a + s) * arc * both;  // Δ(sin θ_a + sin θ)/(cos θ_a + cos θ)
    const Doubles w_per_bend = chord * both, w = w_per_bend * bend;
    store(of(&Pass::z) + dz, depth + j);
    store(of(&Pass::tau) + xi * w_per_bend * atanh_over_w(Doubles(w * w)), time + j);
    store(of(&Pass::q) + rate * d, q + j);
    store(c, cosine + j);
    store(s, sine + j);
    store(c * slow, speed + j);
    store(c * rate, dq_ds + j);
    if constexpr (absorbing) {
      const Doubles straight = sqrt(d * d + dz * dz), y = 0.5 * straight * bend;
      store(of(&Pass::length) + straight * asin_series(y), length + j);
    }
  }
  if (work.flat) return;
  for (std::size_t j = 0; j < n; ++j) {
    const Pass& a = passes[pass_of[j]];
    time[j] = a.tau + layer_time(xi * (ranges[j] - a.r) / (1.0 - a.s * sine[j]), a.bend / xi);
  }
}

/// What changes at boundaries and caustics only, and what absorption leaves: exp(−∫α ds).
void LayeredCrossings::fill_pieces(std::size_t n, Workspace& work, Crossings& out) const {
  const double* q = out.q.data();
  double *level = out.level.data(), *phase = out.phase.data(), *mirror = out.mirror.data();
  for (std::size_t i = 0, first = 0; i < work.piece.size(); ++i) {
    const Piece& a = work.piece[i];
    const bool is_last = i + 1 == work.piece.size();
    const std::size_t end = is_last ? n : column_at(work.pass[work.piece[i + 1].pass].r, first);
    ASDIC_INDEPENDENT
    for (std::size_t j = first; j < end; ++j) {
      level[j] = a.level;
      mirror[j] = a.mirror;
      phase[j] = a.phase + (a.sense * q[j] < 0.0 ? 0.5 * pi : 0.0);
    }
    first = end;
  }
  if (alpha_ == 0.0) return;
  for (std::size_t j = 0; j < n; j += doubles) {  // beyond n there is room
    const Doubles nepers = min(alpha_ * load(&work.length[j]), Doubles(700.0));
    store(load(&out.level[j]) * exponential(-nepers), &out.level[j]);
  }
}

}  // namespace asdic::detail
