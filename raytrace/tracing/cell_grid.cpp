#include "raytrace/tracing/cell_grid.h"

#include <algorithm>
#include <cmath>

#include "raytrace/math/monotone_root.h"
#include "raytrace/ocean/tube_amplitude.h"

namespace asdic::detail {
namespace {

HermiteNode range_node(const StrikingRay& ray, const BoundaryHit& hit) {
  return {ray.angle, hit.range, hit.d_range};
}
HermiteNode time_node(const StrikingRay& ray, const BoundaryHit& hit) {
  return {ray.angle, hit.time, hit.d_time};
}

}  // namespace

CellGrid::CellGrid(const Environment& environment, const GroundGrid& cells, double max_range,
                   double frequency)
    : cells_(cells),
      max_range_(max_range),
      frequency_(frequency),
      spreading_(spreading_across(environment)) {}

void CellGrid::between(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                       const BoundaryHit& hb, std::vector<CellHit>& out) const {
  const Hermite range(range_node(a, ha), range_node(b, hb));
  const Hermite time(time_node(a, ha), time_node(b, hb));
  const bool caustic = (ha.d_range > 0.0) != (hb.d_range > 0.0);
  const auto turns = caustic ? range.extrema() : Hermite::Places{};
  double from = a.angle, from_range = ha.range;
  for (std::size_t i = 0; i <= turns.size(); ++i) {
    const double to = i < turns.size() ? turns.x[i] : b.angle;
    const double to_range = i < turns.size() ? range.value(to) : hb.range;
    monotone(a, ha, b, hb, range, time, from, from_range, to, to_range, out);
    from = to;
    from_range = to_range;
  }
}

void CellGrid::along_chord(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                           const BoundaryHit& hb, std::vector<CellHit>& out) const {
  const double chord = (hb.range - ha.range) / (b.angle - a.angle);
  BoundaryHit first = ha, last = hb;
  for (BoundaryHit* hit : {&first, &last}) {
    hit->d_range = chord;
    hit->d_time = hit->slowness * chord;
  }
  const Hermite range(range_node(a, first), range_node(b, last));
  const Hermite time(time_node(a, first), time_node(b, last));
  monotone(a, first, b, last, range, time, a.angle, first.range, b.angle, last.range, out);
}

bool CellGrid::is_tame(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                       const BoundaryHit& hb) noexcept {
  const double width = b.angle - a.angle, chord = (hb.range - ha.range) / width;
  if ((ha.d_range > 0.0) != (hb.d_range > 0.0))  // a caustic: a parabola, about
    return std::abs(ha.d_range + hb.d_range - 2.0 * chord) <
           0.5 * (std::abs(ha.d_range) + std::abs(hb.d_range));
  // Fritsch & Carlson's condition.
  return ha.d_range / chord >= 0.0 && ha.d_range / chord <= 3.0 && hb.d_range / chord >= 0.0 &&
         hb.d_range / chord <= 3.0;
}

void CellGrid::monotone(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                        const BoundaryHit& hb, const Hermite& range, const Hermite& time,
                        double from, double from_range, double to, double to_range,
                        std::vector<CellHit>& out) const {
  const bool rising = to_range > from_range;
  const double near = rising ? from : to, far = rising ? to : from;
  const double near_range = std::min(from_range, to_range);
  const double limit = std::min(std::max(from_range, to_range), max_range_);
  double alpha = near;
  for (auto cell = static_cast<std::uint32_t>(cells_.count(std::max(0.0, near_range)));; ++cell) {
    const double r = cells_.range(cell);
    if (r >= limit) return;
    alpha = monotone_root(range, r, std::min(near, far), std::max(near, far), rising, alpha,
                          1e-3 * cells_.spacing());  // from the neighbour's
    out.push_back(path(a, ha, b, hb, range, alpha, time.value(alpha), cell));
  }
}

CellHit CellGrid::path(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                       const BoundaryHit& hb, const Hermite& range, double alpha, double delay,
                       std::uint32_t cell) const {
  const double u = (alpha - a.angle) / (b.angle - a.angle);
  const auto between = [u](double x, double y) { return x + u * (y - x); };
  const double slope = range.slope(alpha);
  // Where two rays coalesce: the least |∂r/∂α| = |dr/dξ|·|dξ/dα|, ξ the slowness along the
  // boundary.
  // The cubic's slope is a parabola; its bend where that is zero, if it is anywhere. At a
  // limiting ray, where dr/dα goes to infinity and no caustic is, it is nowhere.
  const double bend_a = range.bend(a.angle), width = b.angle - a.angle;
  const double third = (range.bend(b.angle) - bend_a) / width;
  const double bend = std::sqrt(std::max(0.0, bend_a * bend_a - 2.0 * third * ha.d_range));
  const double turn = (hb.slowness - ha.slowness) / width;
  const double floor =
      turn != 0.0 ? airy_floor(bend / (turn * turn), frequency_) * std::abs(turn) : 0.0;
  const double q = std::max(std::abs(slope), floor) * between(ha.q_per_d_range, hb.q_per_d_range);
  const double r = cells_.range(cell);
  const double spreading = tube_amplitude(
      spreading_, {.speed = between(ha.speed, hb.speed),
                   .q = q,
                   .range = r,
                   .launch_slowness = launch_slowness(alpha, a.source_speed),
                   .speed_integral = r / std::abs(between(ha.mean_slowness, hb.mean_slowness))});
  const bool like_a = (slope > 0.0) == (ha.d_range > 0.0);
  CellHit hit;
  hit.cell = cell;
  hit.launch_elevation = alpha;
  hit.delay = delay;
  hit.grazing = between(ha.grazing, hb.grazing);
  hit.slowness = between(ha.slowness, hb.slowness);
  hit.length = delay * between(ha.length / ha.time, hb.length / hb.time);  // by the mean speed
  hit.down = ha.down;
  hit.surface_bounces = ha.surface_bounces;
  hit.bottom_bounces = ha.bottom_bounces;
  hit.amplitude = path_amplitude(spreading, std::exp(-between(ha.nepers, hb.nepers)),
                                 ha.reflection + u * (hb.reflection - ha.reflection),
                                 like_a ? ha.caustics : hb.caustics);
  return hit;
}

}  // namespace asdic::detail
