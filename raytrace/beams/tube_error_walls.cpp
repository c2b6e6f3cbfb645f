#include <algorithm>
#include <cmath>

#include "raytrace/beams/tube_error.h"

// The error bound of receivers on the surface and on the bottom, where every beam brings its twin
// (boundary_rows.h): a ray that has just been reflected and its neighbour that has yet to be are no
// torn tube there, but one of incident waves. docs/theory/fields.md, "Error bound"
namespace asdic {
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

/// All that it and its twin bring.
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
    const std::complex<double> twin =
        walls_->meeting(kind, column, x.cosine[i], x.sine[i], x.speed[i]).twin();
    const double times = setting_.coherent ? std::abs(1.0 + twin) : 1.0 + std::norm(twin);
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
  if (!meeting.there || meeting.twin() == 0.0) return false;
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
    std::complex<double> twin_a = a.twin(), twin_b = b.twin();
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
        error = as_one, twin_a = a.reflection, twin_b = b.reflection;
        tube = &wall_bounds_.tube, k = 0;
      }
    }
    const auto times = [&](std::complex<double> twin) {
      return setting_.coherent ? std::abs(1.0 + twin) : 1.0 + std::norm(twin);
    };
    const double change = setting_.coherent ? std::abs(twin_a - twin_b)
                                            : std::abs(std::norm(twin_a) - std::norm(twin_b));
    error *= std::max(times(twin_a), times(twin_b));
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

}  // namespace asdic
