// The way from line to line of the water, as long as nothing else can happen on it.
#include <algorithm>
#include <cmath>

#include "raytrace/tracing/march.h"
#include "raytrace/tracing/row_crossing.h"

namespace asdic::tracing {
namespace {

constexpr double least_gap = 1e-9;  // to a shaped boundary [m]

}  // namespace

/// Whether the segment from y_ to next_ stays in the water under (or over) a shaped boundary. It
/// leaves its chord by less than half its turn times its length.
bool March::clear_of(BoundaryKind kind, double turn) const {
  const bool above = kind == BoundaryKind::surface;
  const double sense = above ? 1.0 : -1.0;
  const Wall& w = wall(kind);
  const double bulge = 0.5 * turn * (next_.length - y_.length) + least_gap;
  const bool forward = next_.range >= y_.range;
  if (!w.straight) {  // facets by their furthest depths
    const double nearest =
        above ? std::min(y_.depth, next_.depth) : std::max(y_.depth, next_.depth);
    for (std::size_t i = facet(kind);; forward ? ++i : --i) {
      const Facet& f = w.facets[i];
      if (sense * (nearest - f.extreme) <= bulge) return false;
      if (forward ? next_.range <= f.end : next_.range >= f.begin) return true;
    }
  }
  const auto gap = [&](const Facet& f, double range, double depth) {
    return sense * (depth - f.line.depth - f.slope * (range - f.line.range));
  };
  std::size_t i = facet(kind);
  const double begin = gap(w.facets[i], y_.range, y_.depth);
  if (begin <= bulge) {  // on it or near: leaving by more than the ray may turn
    const double leaving = sense * here_.c * (y_.zeta - w.facets[i].slope * y_.xi);
    if (begin < -least_gap || leaving <= 2.0 * turn * (1.0 + std::abs(w.facets[i].slope)) + 1e-6)
      return false;
  }
  const double per_range = (next_.depth - y_.depth) / (next_.range - y_.range);
  for (;; forward ? ++i : --i) {
    const Facet& f = w.facets[i];
    if (forward ? next_.range <= f.end : next_.range >= f.begin)
      return gap(f, next_.range, next_.depth) > bulge;
    const double node = forward ? f.end : f.begin;
    if (gap(f, node, y_.depth + per_range * (node - y_.range)) <= bulge) return false;
  }
}

/// Goes from line to line while the ray meets nothing but them and flat boundaries on them: no step
/// is planned and no event sought, for Snell's invariant tells the next line's state. Leaves the
/// ray where anything else may come first. \return false: it has ended
bool March::cross_rows() {
  here_ = local(*cell_, y_);
  while (segments_ < limits_.max_segments) {
    const double tz = here_.c * y_.zeta;
    if (cell_->law == Law::bilinear || cell_->law == Law::munk || std::abs(tz) < 0.05) break;
    const bool down = tz > 0.0;
    const Row& row = *cell_->row;
    const double line = down ? row.bottom : row.top;
    if (line == y_.depth || line > limits_.max_depth) break;
    RowCrossing x;
    if (!cross_row(*cell_, y_, here_, line, x)) break;
    next_.range = y_.range + x.range;
    const bool forward = y_.xi >= 0.0;
    if (forward ? next_.range >= std::min(limits_.max_range, ocean_.column_end(column_))
                : next_.range <= std::max(limits_.min_range, ocean_.column_begin(column_)))
      break;
    if (cell_->law == Law::cubic && tells_between(y_.range, next_.range)) break;
    next_.depth = line;
    next_.length = y_.length + x.length;
    if (near_surface_) {
      surface_facet_ = facet_ahead(BoundaryKind::surface);
      if (!clear_of(BoundaryKind::surface, x.turn)) break;
    }
    if (near_bottom_) {
      bottom_facet_ = facet_ahead(BoundaryKind::bottom);
      if (!clear_of(BoundaryKind::bottom, x.turn)) break;
    }
    const double tz_end = std::copysign(x.sine, tz);
    next_.xi = y_.xi;
    next_.zeta = tz_end / x.c;
    next_.time = y_.time + x.time;
    carry_tube(y_.q, y_.p, y_.xi, tz, here_.c_z, x, tz_end, next_.q, next_.p);
    carry_tube(y_.q_plane, y_.p_plane, y_.xi, tz, here_.c_z, x, tz_end, next_.q_plane,
               next_.p_plane);
    next_.nepers = y_.nepers + row.alpha(y_.depth) * x.length + row.alpha_slope * x.depth_integral;
    const double cosine2 = x.c * x.c * y_.xi * y_.xi;
    there_ = {x.c, 0.0, x.c_z, x.c_zz * cosine2};
    creeping_ = false;
    crossed_row_ = true;
    step_ = never;
    keep();
    crossed_row_ = false;
    y_ = next_;
    const auto kind = down ? BoundaryKind::bottom : BoundaryKind::surface;
    if (on_flat(kind)) {
      if (!reflect_at(kind)) return false;
      if (ocean_.reflection != Reflection::on_the_spot) break;
      here_ = there_;
      continue;
    }
    const double c_z = there_.c_z;
    enter_cell(down ? row_ + 1 : row_ - 1, column_);
    here_ = local(*cell_, y_);
    const double jump = -(here_.c_z - c_z) * y_.xi * y_.xi / tz_end;  // as cross() has it
    y_.p += y_.q * jump;
    y_.p_plane += y_.q_plane * jump;
  }
  return true;
}

}  // namespace asdic::tracing
