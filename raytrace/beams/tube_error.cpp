#include "raytrace/beams/tube_error.h"

#include <algorithm>
#include <cmath>

#include <algorithm>
#include "core/simd.h"
#include "raytrace/beams/geometric.h"
#include "raytrace/beams/larger.h"

#include "raytrace/beams/tube_error.h"

namespace asdic::detail {

namespace {

const double root_of_two_pi = std::sqrt(2.0 * pi);

using beams::larger;
using beams::smaller;

}  // namespace

void TubeError::Pieces::resize(std::size_t n) {
  for (auto* array : {&error, &from, &to, &sigma}) array->resize(n);
}

void TubeError::Bounds::resize(std::size_t n) {
  for (Pieces* pieces : {&tube, &lower, &higher}) pieces->resize(n);
}

TubeError::TubeError(const BeamSetting& setting, std::span<const double> depths,
                     std::size_t columns, std::size_t first_left_out, std::size_t last_left_out,
                     const BoundaryRows* walls)
    : setting_(setting),
      depths_(depths),
      first_depth_(depths.front()),
      first_left_out_(first_left_out),
      last_left_out_(last_left_out),
      stride_(depths.size() + 1),
      walls_(walls != nullptr && walls->any() ? walls : nullptr) {
  sum_.assign(columns * stride_, 0.0);
  head_.assign(columns, -1);
  const std::size_t n = depths.size();
  const double step = n < 2 ? 0.0 : (depths.back() - first_depth_) / double(n - 1);
  bool even = step > 0.0;
  for (std::size_t k = 0; k < n; ++k)
    even = even && std::abs(depths[k] - (first_depth_ + double(k) * step)) < 1e-3 * step;
  if (even) per_spacing_ = 1.0 / step;
  if (walls_ == nullptr) return;
  for (auto& at_wall : at_walls_) at_wall.assign(columns, 0.0);
  wall_bounds_.resize(1);
  unfolded_.resize(1), unfolded_.crossings.resize(1);
}

/// From crossing i of the lower ray and j of the higher one on, `count` pairs.
/// docs/theory/fields.md, eq. (1) to (3)
template <bool hat, bool coherent>
void TubeError::bound_of_kind(const RayAtColumns& a, std::size_t i, const RayAtColumns& b,
                              std::size_t j, std::size_t count, double width, Bounds& out) const {
  const double *higher_a = a.higher.data() + i, *size_a = a.size.data() + i,
               *growth_a = a.growth.data() + i, *cosine_a = a.cosine.data() + i,
               *turned_a = a.crossings.phase.data() + i, *mirror_a = a.crossings.mirror.data() + i,
               *phase_a = a.phase.data() + i, *number_a = a.wave_number.data() + i,
               *least_a = a.least.data() + i, *amplitude_a = a.amplitude.data() + i,
               *power_a = a.power.data() + i, *depth_a = a.crossings.depth.data() + i;
  const double *higher_b = b.higher.data() + j, *size_b = b.size.data() + j,
               *growth_b = b.growth.data() + j, *cosine_b = b.cosine.data() + j,
               *turned_b = b.crossings.phase.data() + j, *mirror_b = b.crossings.mirror.data() + j,
               *phase_b = b.phase.data() + j, *number_b = b.wave_number.data() + j,
               *least_b = b.least.data() + j, *amplitude_b = b.amplitude.data() + j,
               *power_b = b.power.data() + j, *depth_b = b.crossings.depth.data() + j;
  double *tube_error = out.tube.error.data(), *tube_from = out.tube.from.data(),
         *tube_to = out.tube.to.data(), *tube_sigma = out.tube.sigma.data(),
         *lower_error = out.lower.error.data(), *lower_from = out.lower.from.data(),
         *lower_to = out.lower.to.data(), *lower_sigma = out.lower.sigma.data(),
         *higher_error = out.higher.error.data(), *higher_from = out.higher.from.data(),
         *higher_to = out.higher.to.data(), *higher_sigma = out.higher.sigma.data();
  ASDIC_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double za = depth_a[k], zb = depth_b[k], dz = zb - za;
    const double apart = std::abs(dz), side_a = higher_a[k], side_b = -higher_b[k];
    // |q| of each ray's beam at the other; its hat's weight there, 0 if that is where it was
    // foretold
    const double there_a = size_a[k] + growth_a[k] * dz, there_b = size_b[k] - growth_b[k] * dz;
    const double weight_a = 1.0 - apart * cosine_a[k] / (there_a * width);
    const double weight_b = 1.0 - apart * cosine_b[k] / (there_b * width);
    const double weight = larger(std::abs(weight_a), std::abs(weight_b));
    // The phase that each foretells for the other; reflections and caustics to the nearest turn.
    const double cycles = turned_a[k] - turned_b[k];
    const double whole = 2.0 * pi * std::floor(cycles / (2.0 * pi) + 0.5);
    const double ahead = phase_a[k] - phase_b[k] - whole;
    const double phase =
        coherent ? larger(std::abs(ahead + number_a[k] * dz), std::abs(ahead + number_b[k] * dz))
                 : 0.0;
    // The beams: reach of a hat, σ of a Gaussian along the column, amplitude at the ray.
    const double open_a = cosine_a[k] - side_a * growth_a[k] * width;
    const double open_b = cosine_b[k] - side_b * growth_b[k] * width;
    const double reach_a = hat ? size_a[k] * width / larger(open_a, 0.5 * cosine_a[k]) : 0.0;
    const double reach_b = hat ? size_b[k] * width / larger(open_b, 0.5 * cosine_b[k]) : 0.0;
    const double across_a = larger(size_a[k] * width, least_a[k]);
    const double across_b = larger(size_b[k] * width, least_b[k]);
    const double share_a = hat ? 1.0 : size_a[k] * width / (across_a * root_of_two_pi);
    const double share_b = hat ? 1.0 : size_b[k] * width / (across_b * root_of_two_pi);
    const double sigma_a = hat ? 0.0 : across_a / cosine_a[k];
    const double sigma_b = hat ? 0.0 : across_b / cosine_b[k];
    const double amp_a = share_a * amplitude_a[k], amp_b = share_b * amplitude_b[k];
    const double most = larger(amp_a, amp_b), both = amp_a + amp_b,
                 change = std::abs(amp_a - amp_b);
    const double smooth = hat ? most * (weight + 0.25 * phase) + 0.5 * change
                              : 0.5 * (most * (weight + phase) + change);
    // Torn: on the wrong side, behind a caustic, mirrored once more, or not foretold at all. The
    // power of the rays in between is that of the two, on the average.
    const double ordered = smaller(smaller(dz * side_a, -dz * side_b), smaller(there_a, there_b));
    const double mirrored = std::abs(mirror_a[k] - mirror_b[k]);
    const double torn = (ordered < 0.0 ? 1.0 : 0.0) + mirrored + (smooth > both ? 1.0 : 0.0) +
                        (there_a * there_b == 0.0 ? 1.0 : 0.0);
    const double mean = larger(power_a[k], power_b[k]) * width / larger(apart, 1e-9);
    const double between = smaller(coherent ? std::sqrt(mean) : mean, both);
    const double part = torn > 0.0 ? (hat ? 1.0 : 0.5) : 0.0;
    const double end_a = za + side_a * reach_a, end_b = zb + side_b * reach_b;
    const double low = smaller(za, zb), high = larger(za, zb);
    tube_error[k] = torn > 0.0 ? between : smooth;
    tube_from[k] = torn > 0.0 ? low : smaller(low, smaller(end_a, end_b));
    tube_to[k] = torn > 0.0 ? high : larger(high, larger(end_a, end_b));
    tube_sigma[k] = larger(sigma_a, sigma_b);
    lower_error[k] = part * amp_a;
    lower_from[k] = smaller(za, end_a);
    lower_to[k] = larger(za, end_a);
    lower_sigma[k] = sigma_a;
    higher_error[k] = part * amp_b;
    higher_from[k] = smaller(zb, end_b);
    higher_to[k] = larger(zb, end_b);
    higher_sigma[k] = sigma_b;
  }
}

void TubeError::bound(const RayAtColumns& a, std::size_t i, const RayAtColumns& b, std::size_t j,
                      std::size_t count, double width, Bounds& out) const {
  const bool hat = setting_.kind == BeamKind::hat, coherent = setting_.coherent;
  if (hat && coherent) return bound_of_kind<true, true>(a, i, b, j, count, width, out);
  if (hat) return bound_of_kind<true, false>(a, i, b, j, count, width, out);
  if (coherent) return bound_of_kind<false, true>(a, i, b, j, count, width, out);
  bound_of_kind<false, false>(a, i, b, j, count, width, out);
}

inline double TubeError::put_between(std::size_t column, double error, double from, double to) {
  const auto rows = static_cast<double>(depths_.size());
  std::int32_t first, last;
  if (per_spacing_ > 0.0) {
    const double a = std::ceil((from - first_depth_) * per_spacing_);
    const double b = std::floor((to - first_depth_) * per_spacing_) + 1.0;
    first = static_cast<std::int32_t>(smaller(larger(a, 0.0), rows));
    last = static_cast<std::int32_t>(smaller(larger(b, 0.0), rows));
  } else {
    first = static_cast<std::int32_t>(std::lower_bound(depths_.begin(), depths_.end(), from) -
                                      depths_.begin());
    last = static_cast<std::int32_t>(std::upper_bound(depths_.begin(), depths_.end(), to) -
                                     depths_.begin());
  }
  if (last <= first) return 0.0;
  double* sum = sum_.data() + column * stride_;
  sum[first] += error;
  sum[last] -= error;
  std::int32_t counted = last - first;
  if (first_left_out_ < last_left_out_)
    counted -= std::max(0, std::min(last, static_cast<std::int32_t>(last_left_out_)) -
                               std::max(first, static_cast<std::int32_t>(first_left_out_)));
  if (walls_ != nullptr)
    counted -= static_cast<std::int32_t>(
        on_walls(column, static_cast<std::size_t>(first), static_cast<std::size_t>(last)));
  return static_cast<double>(std::max(counted, 0));
}

double TubeError::put(std::size_t column, const Piece& piece, double level) {
  const auto& [error, from, to, sigma] = piece;
  double receivers = 0.0;
  if (sigma == 0.0) {
    receivers = put_between(column, error, from, to);
  } else {  // a staircase over e^(−u²/2): steps at whole u
    constexpr double step[4] = {1.0 - 0.60653066, 0.60653066 - 0.13533528, 0.13533528 - 0.011108997,
                                0.011108997};
    const bool received = from - 4.0 * sigma <= depths_.back() && to + 4.0 * sigma >= first_depth_;
    for (int u = 1; received && u <= 4; ++u)
      receivers +=
          step[u - 1] * put_between(column, step[u - 1] * error, from - u * sigma, to + u * sigma);
  }
  return receivers * std::min(error / level, 1.0);
}

/// A ray without a neighbour: all that it brings is unsure.
TubeError::Piece TubeError::alone(const RayAtColumns& ray, std::size_t i,
                                  double width) const noexcept {
  const bool hat = setting_.kind == BeamKind::hat;
  const double across = larger(ray.size[i] * width, ray.least[i]), z = ray.crossings.depth[i];
  const double reach = hat ? across / ray.cosine[i] : 0.0;
  const double share = hat ? 1.0 : ray.size[i] * width / (across * root_of_two_pi);
  return {share * ray.amplitude[i], z - reach, z + reach, hat ? 0.0 : across / ray.cosine[i]};
}

double TubeError::put_alone(const RayAtColumns& ray, std::size_t i, double width, double level) {
  const Piece piece = alone(ray, i, width);
  const double share = put(ray.crossings.column[i], piece, level);
  return walls_ == nullptr ? share : share + put_alone_at_walls(piece, ray, i, level);
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
    bound(lower, 0, higher, 0, n, width, bounds_);
    for (std::size_t i = 0; i < n; ++i)
      share += put_tube(i, i, level[i], {lower, higher, i, i, width});
    for (std::size_t i = n; i < a.size(); ++i) share += put_alone(lower, i, width, level[i]);
    for (std::size_t i = n; i < b.size(); ++i) share += put_alone(higher, i, width, level[i]);
    return share;
  }
  // The first crossing of a column belongs to the neighbour's first, the second to its second, …
  bounds_.resize(1);
  next_.assign(b.size(), -1);
  for (std::size_t j = b.size(); j-- > 0;) {
    next_[j] = head_[b.column[j]];
    head_[b.column[j]] = static_cast<std::int32_t>(j);
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t column = a.column[i];
    const std::int32_t j = head_[column];
    if (j < 0) {
      share += put_alone(lower, i, width, level[column]);
      continue;
    }
    const auto k = static_cast<std::size_t>(j);
    head_[column] = next_[k];
    bound(lower, i, higher, k, 1, width, bounds_);
    share += put_tube(column, 0, level[column], {lower, higher, i, k, width});
  }
  for (std::size_t j = 0; j < b.size(); ++j) {
    std::int32_t& left = head_[b.column[j]];
    for (; left >= 0; left = next_[static_cast<std::size_t>(left)])
      share += put_alone(higher, static_cast<std::size_t>(left), width, level[b.column[j]]);
  }
  return share;
}

double TubeError::add_end(const RayAtColumns& ray, double width, std::span<const double> level) {
  double share = 0.0;
  for (std::size_t i = 0; i < ray.crossings.size(); ++i) {
    share += put_alone(ray, i, width, level[ray.crossings.column[i]]);
  }
  return share;
}

double TubeError::put_tube(std::size_t column, std::size_t n, double level, const Pair& pair) {
  double share = put(column, bounds_.tube[n], level);
  if (bounds_.lower.error[n] > 0.0 || bounds_.higher.error[n] > 0.0)
    share += put(column, bounds_.lower[n], level) + put(column, bounds_.higher[n], level);
  return walls_ == nullptr ? share : share + put_tube_at_walls(column, n, level, pair);
}

void TubeError::finish() {
  for (std::size_t i = 0; i < sum_.size(); i += stride_)
    for (std::size_t k = 1; k < stride_; ++k) sum_[i + k] += sum_[i + k - 1];
  if (walls_ != nullptr) finish_walls();
}

// The error bound of receivers on the surface and on the bottom, where every beam brings its
// partner (boundary_rows.h): a ray that has just been reflected and its neighbour that has yet to
// be are no torn tube there, but one of incident waves. docs/theory/fields.md, "Error bound"

namespace {

constexpr BoundaryKind both_walls[2] = {BoundaryKind::surface, BoundaryKind::bottom};

std::size_t which(BoundaryKind kind) noexcept { return kind == BoundaryKind::surface ? 0 : 1; }

}  // namespace

double TubeError::Piece::at(double depth) const noexcept {
  const double beyond = std::max({from - depth, depth - to, 0.0});
  if (beyond == 0.0) return error;
  if (!(beyond < 4.0 * sigma)) return 0.0;
  const double u = std::floor(beyond / sigma);  // the staircase of put()
  return error * std::exp(-0.5 * u * u);
}

/// Which of rows [first, last) are on a boundary: how many.
std::size_t TubeError::on_walls(std::size_t column, std::size_t first,
                                std::size_t last) const noexcept {
  std::size_t count = 0;
  for (const BoundaryKind kind : both_walls) {
    const std::int32_t row = walls_->row(kind, column);
    if (row >= static_cast<std::int32_t>(first) && row < static_cast<std::int32_t>(last)) ++count;
  }
  return count;
}

double TubeError::put_at_wall(BoundaryKind kind, std::size_t column, double error, double level) {
  at_walls_[which(kind)][column] += error;
  return std::min(error / level, 1.0);
}

/// All that it and its partner bring.
double TubeError::put_alone_at_walls(const Piece& piece, const RayAtColumns& ray, std::size_t i,
                                     double level) {
  const Crossings& x = ray.crossings;
  const std::size_t column = x.column[i];
  double share = 0.0;
  for (const BoundaryKind kind : both_walls) {
    const std::int32_t row = walls_->row(kind, column);
    if (row < 0 || walls_->silent(kind, column)) continue;
    const double error = piece.at(depths_[static_cast<std::size_t>(row)]);
    if (error == 0.0) continue;
    const std::complex<double> partner =
        walls_->meeting(kind, column, x.cosine[i], x.sine[i], x.speed[i]).partner();
    const double times = setting_.coherent ? std::abs(1.0 + partner) : 1.0 + std::norm(partner);
    share += put_at_wall(kind, column, times * error, level);
  }
  return share;
}

/// The crossing as it would be had the ray gone on straight through the boundary where it was
/// reflected: its mirror image in the boundary's tangent. \return whether there is one
bool TubeError::unfold(const RayAtColumns& ray, std::size_t i, BoundaryKind kind,
                       const WallMeeting& meeting) {
  const Crossings& x = ray.crossings;
  const double strength = std::abs(meeting.reflection), m = meeting.slope;
  if (!meeting.there || meeting.partner() == 0.0) return false;
  const std::size_t column = x.column[i];
  const double wall = depths_[static_cast<std::size_t>(walls_->row(kind, column))];
  // β → 2·atan(m) − β
  const double cosine = ((1.0 - m * m) * x.cosine[i] + 2.0 * m * x.sine[i]) / (1.0 + m * m);
  const double sine = (2.0 * m * x.cosine[i] - (1.0 - m * m) * x.sine[i]) / (1.0 + m * m);
  const double leaving = m * x.cosine[i] - x.sine[i], entering = sine - m * cosine;
  if (!(std::abs(leaving) > 1e-9) || !(std::abs(cosine) > 1e-9)) return false;
  const double since = (wall - x.depth[i]) * x.cosine[i] / leaving;  // r − r_w, from its reflection
  const double before = since / cosine - since / x.cosine[i];        // of arc length, s′ − s
  RayAtColumns& to = unfolded_;
  const double q = x.q[i] + x.dq_ds[i] * before;
  to.size[0] = std::max(std::abs(q), 1e-9);
  to.growth[0] = (q < 0.0 ? -1.0 : 1.0) * x.dq_ds[i] * sine;
  to.cosine[0] = std::abs(cosine);
  to.higher[0] = q * cosine * -x.mirror[i] > 0.0 ? -1.0 : 1.0;
  const double lost = setting_.coherent ? strength : strength * strength;
  to.amplitude[0] = ray.amplitude[i] / lost;
  to.power[0] = ray.power[i] * ray.cosine[i] / (strength * strength * to.cosine[0]);
  const double k = 2.0 * pi * setting_.frequency / x.speed[i];
  to.phase[0] = ray.phase[i] - std::arg(meeting.reflection) - k * before;
  to.wave_number[0] = -k * sine;
  to.least[0] = ray.least[i];
  to.crossings.column[0] = x.column[i];
  to.crossings.depth[0] = wall + entering * since / cosine;
  to.crossings.phase[0] = x.phase[i] - std::arg(meeting.reflection);
  to.crossings.mirror[0] = -x.mirror[i];
  return true;
}

/// (1 + R) times the bound of the incident wave, and what R changes from one ray to the other.
double TubeError::put_tube_at_walls(std::size_t column, std::size_t n, double level,
                                    const Pair& pair) {
  const Crossings &xa = pair.a.crossings, &xb = pair.b.crossings;
  const std::size_t i = pair.i, j = pair.j;
  double share = 0.0;
  for (const BoundaryKind kind : both_walls) {
    const std::int32_t row = walls_->row(kind, column);
    if (row < 0 || walls_->silent(kind, column)) continue;
    const double z = depths_[static_cast<std::size_t>(row)];
    const auto error_of = [&](const Bounds& bounds, std::size_t k) {
      const double torn = bounds.lower[k].at(z) + bounds.higher[k].at(z);
      return bounds.tube[k].at(z) + torn;
    };
    double error = error_of(bounds_, n);
    if (error == 0.0) continue;
    const WallMeeting a = walls_->meeting(kind, column, xa.cosine[i], xa.sine[i], xa.speed[i]);
    const WallMeeting b = walls_->meeting(kind, column, xb.cosine[j], xb.sine[j], xb.speed[j]);
    std::complex<double> partner_a = a.partner(), partner_b = b.partner();
    const Pieces* tube = &bounds_.tube;
    std::size_t k = n;
    const bool parted = xa.mirror[i] != xb.mirror[j] && a.reflected != b.reflected;
    if (parted && (a.reflected ? unfold(pair.a, i, kind, a) : unfold(pair.b, j, kind, b))) {
      if (a.reflected)
        bound(unfolded_, 0, pair.b, j, 1, pair.width, wall_bounds_);
      else
        bound(pair.a, i, unfolded_, 0, 1, pair.width, wall_bounds_);
      const double as_one = error_of(wall_bounds_, 0);
      if (wall_bounds_.lower.error[0] == 0.0) {  // else this is not where they part
        error = as_one, partner_a = a.reflection, partner_b = b.reflection;
        tube = &wall_bounds_.tube, k = 0;
      }
    }
    const auto times = [&](std::complex<double> partner) {
      return setting_.coherent ? std::abs(1.0 + partner) : 1.0 + std::norm(partner);
    };
    const double change = setting_.coherent ? std::abs(partner_a - partner_b)
                                            : std::abs(std::norm(partner_a) - std::norm(partner_b));
    error *= std::max(times(partner_a), times(partner_b));
    const double lesser = std::min(alone(pair.a, i, pair.width).error,  // of the beams there
                                   alone(pair.b, j, pair.width).error);
    error += 0.5 * change * lesser * Piece{1.0, tube->from[k], tube->to[k], tube->sigma[k]}.at(z);
    share += put_at_wall(kind, column, error, level);
  }
  return share;
}

void TubeError::finish_walls() {
  for (const BoundaryKind kind : both_walls)
    for (std::size_t j = 0; j < at_walls_[0].size(); ++j)
      if (const std::int32_t row = walls_->row(kind, j); row >= 0)
        sum_[j * stride_ + static_cast<std::size_t>(row)] = at_walls_[which(kind)][j];
}

}  // namespace asdic::detail
