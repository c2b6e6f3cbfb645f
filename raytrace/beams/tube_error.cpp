#include "raytrace/beams/tube_error.h"

#include <algorithm>
#include <cmath>

#include "raytrace/beams/lanes.h"

namespace asdic {

namespace {

const double root_of_two_pi = std::sqrt(2.0 * pi);

/// To the nearest whole number of turns.
inline double within_half_a_turn(double angle) noexcept {
  return angle - 2.0 * pi * std::floor(angle / (2.0 * pi) + 0.5);
}

/// What one ray foretells: how far its beam reaches along the column, and its neighbour.
struct Foretold {
  double amplitude;  ///< of its beam at the ray (squared where intensities are added)
  double power;      ///< amplitude² × |q|/cos θ of the ray itself
  double sigma;      ///< least half-width of a Gaussian along the column [m]
  double reach;      ///< of a hat along the column [m], ≥ 0
  double weight;     ///< of its hat at the neighbour: 0 if that is where it was expected
  double phase;      ///< at the neighbour [rad]
  bool astray;       ///< the neighbour is not on its side, or behind a caustic
};

}  // namespace

TubeError::TubeError(const BeamSetting& setting, std::span<const double> depths,
                     std::size_t columns)
    : setting_(setting), depths_(depths), first_depth_(depths.front()), stride_(depths.size() + 1) {
  sum_.assign(columns * stride_, 0.0);
  head_.assign(columns, -1);
  const std::size_t n = depths.size();
  const double step = n < 2 ? 0.0 : (depths.back() - first_depth_) / double(n - 1);
  bool even = step > 0.0;
  for (std::size_t k = 0; k < n; ++k)
    even = even && std::abs(depths[k] - (first_depth_ + double(k) * step)) < 1e-3 * step;
  if (even) per_spacing_ = 1.0 / step;
}

/// `dz` is where the neighbour is, `side` where it should be: ±1 towards higher rays or lower ones.
static inline Foretold foretell(const BeamSetting& setting, const RayAtColumns& ray, std::size_t i,
                                double dz, double side, double width) noexcept {
  const Crossings& x = ray.crossings;
  const double q = x.q[i], cosine = std::abs(x.cosine[i]), sine = x.sine[i], c = x.speed[i];
  const double omega = 2.0 * pi * setting.frequency;
  const double toward = (q * x.cosine[i] * x.mirror[i] > 0.0 ? -1.0 : 1.0) * side;
  const double size = std::max(std::abs(q), 1e-9);
  const double growth = (q < 0.0 ? -1.0 : 1.0) * x.dq_ds[i] * sine;  // of |q| downwards
  const double there = size + growth * dz;                           // |q| at the neighbour's foot
  Foretold f;
  f.astray = dz * toward < 0.0 || there <= 0.0;
  f.weight = there > 0.0 ? 1.0 - std::abs(dz) * cosine / (there * width) : 1.0;
  // n < L: |dz|·cos θ < (|q| + growth·dz)·Δα; no further than twice as far as without growth
  const double narrowed = cosine - toward * growth * width;
  f.reach = size * width / (narrowed > 0.5 * cosine ? narrowed : 0.5 * cosine);
  f.phase = x.phase[i] - omega * (x.time[i] + dz * sine / c);
  const double intensity = ray.launched * ray.launched * x.level[i] * x.level[i] * c /
                           x.source_speed;  // · W² / |q|, of the ray
  const double least_a = 0.2 * setting.frequency * x.time[i], least_b = pi * c / setting.frequency;
  const double across = std::max(size * width, least_a < least_b ? least_a : least_b);
  f.sigma = across / cosine;
  f.power = intensity / cosine;
  const double share =
      setting.kind == BeamKind::hat ? 1.0 : size * width / (across * root_of_two_pi);
  f.amplitude = setting.coherent ? share * std::sqrt(intensity / size) : share * intensity / size;
  return f;
}

TubeError::Bound TubeError::bound(const RayAtColumns& a, std::size_t i, const RayAtColumns& b,
                                  std::size_t j, double width) const noexcept {
  const double za = a.crossings.depth[i], zb = b.crossings.depth[j];
  const Foretold fa = foretell(setting_, a, i, zb - za, 1.0, width);
  const Foretold fb = foretell(setting_, b, j, za - zb, -1.0, width);
  const bool hat = setting_.kind == BeamKind::hat;
  const double larger = std::max(fa.amplitude, fb.amplitude), both = fa.amplitude + fb.amplitude;
  const double weight = std::max(std::abs(fa.weight), std::abs(fb.weight));
  double phase = 0.0;
  if (setting_.coherent) {
    // each foretells the other's phase there, where that one is sure of it
    const double omega = 2.0 * pi * setting_.frequency;
    const double at_a = a.crossings.phase[i] - omega * a.crossings.time[i];
    const double at_b = b.crossings.phase[j] - omega * b.crossings.time[j];
    const double turns = a.crossings.phase[i] - b.crossings.phase[j];
    const double whole = turns - within_half_a_turn(turns);
    phase = std::max(std::abs(fa.phase - at_b - whole), std::abs(fb.phase - at_a + whole));
  }
  const double change = std::abs(fa.amplitude - fb.amplitude);
  const bool astray = fa.astray || fb.astray || a.crossings.mirror[i] != b.crossings.mirror[j];
  const double smooth = hat ? larger * (weight + 0.25 * phase) + 0.5 * change
                            : 0.5 * (larger * (weight + phase) + change);
  const double toward_a =
      a.crossings.q[i] * a.crossings.cosine[i] * a.crossings.mirror[i] > 0.0 ? -1.0 : 1.0;
  const double toward_b =
      b.crossings.q[j] * b.crossings.cosine[j] * b.crossings.mirror[j] > 0.0 ? 1.0 : -1.0;
  const double end_a = hat ? za + toward_a * fa.reach : za;
  const double end_b = hat ? zb + toward_b * fb.reach : zb;
  const bool torn = astray || smooth > both;
  // Torn: the power of all rays in between is that of the two, √(Δα/H) for 1/√|q|; its mean.
  const double apart =
      std::max(std::abs(zb - za), 1e-9) / std::max(width, 1e-12);  // as a |q|/cos θ
  const double mean = std::max(fa.power, fb.power) / apart;
  const double between = setting_.coherent ? std::sqrt(mean) : mean;
  const double part = torn ? (hat ? 1.0 : 0.5) : 0.0;
  const double low = std::min(za, zb), high = std::max(za, zb);
  const double sigma_a = hat ? 0.0 : fa.sigma, sigma_b = hat ? 0.0 : fb.sigma;
  Bound result;
  result.tube = {torn ? std::min(between, both) : smooth,
                 torn ? low : std::min(low, std::min(end_a, end_b)),
                 torn ? high : std::max(high, std::max(end_a, end_b)), std::max(sigma_a, sigma_b)};
  result.lower = {part * fa.amplitude, std::min(za, end_a), std::max(za, end_a), sigma_a};
  result.higher = {part * fb.amplitude, std::min(zb, end_b), std::max(zb, end_b), sigma_b};
  return result;
}

/// A ray without a neighbour: all that it brings is unsure.
TubeError::Bound TubeError::alone(const RayAtColumns& a, std::size_t i,
                                  double width) const noexcept {
  const Foretold f = foretell(setting_, a, i, 0.0, 1.0, width);
  const double z = a.crossings.depth[i];
  const bool hat = setting_.kind == BeamKind::hat;
  const double reach = hat ? f.reach : 0.0;
  return {
      .tube = {f.amplitude, z - reach, z + reach, hat ? 0.0 : f.sigma}, .lower = {}, .higher = {}};
}

double TubeError::add(const RayAtColumns& lower, const RayAtColumns& higher, double width,
                      std::span<const double> level) {
  const Crossings &a = lower.crossings, &b = higher.crossings;
  const std::size_t n = std::min(a.size(), b.size());
  const auto simple = [](const Crossings& x) {
    return x.size() == 0 || (x.column.front() == 0 && x.column.back() + 1 == x.size() &&
                             std::is_sorted(x.column.begin(), x.column.end()));
  };
  double share = 0.0;
  if (simple(a) && simple(b)) {  // each column once, in order
    bounds_.resize(n);
    ASDIC_INDEPENDENT
    for (std::size_t i = 0; i < n; ++i) bounds_[i] = bound(lower, i, higher, i, width);
    for (std::size_t i = 0; i < n; ++i) share += put(i, bounds_[i], level[i]);
    for (std::size_t i = n; i < a.size(); ++i) share += put(i, alone(lower, i, width), level[i]);
    for (std::size_t i = n; i < b.size(); ++i) share += put(i, alone(higher, i, width), level[i]);
    return share;
  }
  // The first crossing of a column belongs to the neighbour's first, the second to its second, …
  next_.assign(b.size(), -1);
  for (std::size_t j = b.size(); j-- > 0;) {
    next_[j] = head_[b.column[j]];
    head_[b.column[j]] = static_cast<std::int32_t>(j);
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t column = a.column[i];
    const std::int32_t j = head_[column];
    if (j < 0) {
      share += put(column, alone(lower, i, width), level[column]);
      continue;
    }
    const auto k = static_cast<std::size_t>(j);
    head_[column] = next_[k];
    share += put(column, bound(lower, i, higher, k, width), level[column]);
  }
  for (std::size_t j = 0; j < b.size(); ++j) {
    std::int32_t& left = head_[b.column[j]];
    for (; left >= 0; left = next_[static_cast<std::size_t>(left)])
      share += put(b.column[j], alone(higher, static_cast<std::size_t>(left), width),
                   level[b.column[j]]);
  }
  return share;
}

double TubeError::add_end(const RayAtColumns& ray, double width, std::span<const double> level) {
  double share = 0.0;
  for (std::size_t i = 0; i < ray.crossings.size(); ++i) {
    const std::size_t column = ray.crossings.column[i];
    share += put(column, alone(ray, i, width), level[column]);
  }
  return share;
}

double TubeError::put(std::size_t column, const Bound& bound, double level) {
  double share = put(column, bound.tube, level);
  if (bound.lower.error > 0.0) share += put(column, bound.lower, level);
  if (bound.higher.error > 0.0) share += put(column, bound.higher, level);
  return share;
}

double TubeError::put(std::size_t column, const Piece& piece, double level) {
  double receivers;
  if (piece.sigma == 0.0) {
    receivers = put_between(column, piece.error, piece.from, piece.to);
  } else {  // a staircase over e^(−u²/2): steps at whole u
    constexpr double step[4] = {1.0 - 0.60653066, 0.60653066 - 0.13533528, 0.13533528 - 0.011108997,
                                0.011108997};
    receivers = 0.0;
    for (int u = 1; u <= 4; ++u)
      receivers +=
          step[u - 1] * put_between(column, step[u - 1] * piece.error, piece.from - u * piece.sigma,
                                    piece.to + u * piece.sigma);
  }
  return receivers * std::min(piece.error / level, 1.0);
}

double TubeError::put_between(std::size_t column, double error, double from, double to) {
  const auto rows = static_cast<double>(depths_.size());
  std::size_t first, last;
  if (per_spacing_ > 0.0) {
    const double a = std::ceil((from - first_depth_) * per_spacing_);
    const double b = std::floor((to - first_depth_) * per_spacing_) + 1.0;
    first = static_cast<std::size_t>(std::clamp(a, 0.0, rows));
    last = static_cast<std::size_t>(std::clamp(b, 0.0, rows));
  } else {
    first = static_cast<std::size_t>(std::lower_bound(depths_.begin(), depths_.end(), from) -
                                     depths_.begin());
    last = static_cast<std::size_t>(std::upper_bound(depths_.begin(), depths_.end(), to) -
                                    depths_.begin());
  }
  if (last <= first) return 0.0;
  double* sum = sum_.data() + column * stride_;
  sum[first] += error;
  sum[last] -= error;
  return static_cast<double>(last - first);
}

void TubeError::finish() {
  for (std::size_t i = 0; i < sum_.size(); i += stride_)
    for (std::size_t k = 1; k < stride_; ++k) sum_[i + k] += sum_[i + k - 1];
}

}  // namespace asdic
