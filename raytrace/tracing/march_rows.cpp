// The way from line to line of the water, as long as nothing else can happen on it.
#include <algorithm>
#include <cmath>

#include "raytrace/tracing/march.h"
#include "raytrace/tracing/row_crossing.h"

namespace asdic::detail::tracing {
namespace {

constexpr double least_gap = 1e-9;  // to a shaped boundary [m]

}  // namespace

/// Whether the segment from y_ to next_ stays in the water under (or over) a shaped boundary. It
/// leaves its chord by less than half its turn times its length. \param sine  the least |t_z| at
/// its ends
bool March::clear_of(BoundaryKind kind, double sine, double turn) const {
  const bool above = kind == BoundaryKind::surface;
  const double sense = above ? 1.0 : -1.0;
  const Wall& w = wall(kind);
  const double least = sine - turn;
  if (least > 0.0 && least * least > w.steepest * w.steepest * (1.0 - least * least)) {
    // steeper than the boundary all along: it leaves it for good, or meets it if it ends behind it
    const bool leaving = sense * y_.zeta > 0.0;
    const RayState& y = leaving ? y_ : next_;
    std::size_t i = facet(kind);
    while (y.range > w.facets[i].end) ++i;
    while (y.range < w.facets[i].begin) --i;
    const Facet& f = w.facets[i];
    const double gap =
        sense * (y.depth - (w.straight ? f.line.depth + f.slope * (y.range - f.line.range)
                                       : boundary(kind).shape->depth_at(y.range, i)));
    return leaving ? gap >= -least_gap : gap > least_gap;
  }
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

/// Whether a straight ray meets a shaped boundary, its facets taken for their lines, before a line
/// of the row: then that line is no place to go to at once.
bool March::stopped_before(double line, BoundaryKind kind) const {
  const double range = y_.range + (line - y_.depth) * y_.xi / y_.zeta;
  const auto& facets = wall(kind).facets;
  std::size_t i = facet(kind);
  while (range > facets[i].end) ++i;
  while (range < facets[i].begin) --i;
  const double beyond =
      line - facets[i].line.depth - facets[i].slope * (range - facets[i].line.range);
  return kind == BoundaryKind::surface ? beyond < 0.0 : beyond > 0.0;
}

/// By Snell's invariant to a line of the row: next_, there_. \return how much it turns, infinity if
/// that is too much or it does not get there
double March::cross_by_invariant(double line) {
  RowCrossing x;
  if (!cross_row(*cell_, y_, here_, line, x)) return never;
  const double tz = here_.c * y_.zeta, tz_end = std::copysign(x.sine, tz);
  const Row& row = *cell_->row;
  next_.range = y_.range + x.range;
  next_.depth = line;
  next_.xi = y_.xi;
  next_.zeta = tz_end / x.c;
  next_.time = y_.time + x.time;
  carry_tube(y_.q, y_.p, y_.xi, tz, here_.c_z, x, tz_end, next_.q, next_.p);
  carry_tube(y_.q_plane, y_.p_plane, y_.xi, tz, here_.c_z, x, tz_end, next_.q_plane, next_.p_plane);
  next_.nepers = y_.nepers + row.alpha(y_.depth) * x.length + row.alpha_slope * x.depth_integral;
  next_.length = y_.length + x.length;
  next_.speed_integral = y_.speed_integral + x.speed_integral;
  const double cosine = x.c * y_.xi;
  there_ = {x.c, 0.0, x.c_z, x.c_zz * cosine * cosine};
  crossed_row_ = true;
  step_ = never;
  return x.turn;
}

/// The same in a section, where one power series has to get there.
double March::cross_by_series(double line) {
  const double tr = here_.c * y_.xi, tz = here_.c * y_.zeta;
  if (std::abs(tr) < 0.1 || std::abs(tz) < 0.1) return never;
  const bool down = tz > 0.0;
  course_.begin(*cell_, y_, here_);
  course_.expand(1.02 * guess(down));
  const double last = course_.reach(), sense = down ? 1.0 : -1.0;
  const auto left = [&](double h) {
    const ValueSlope z = course_.sink(h);
    return ValueSlope{sense * (line - y_.depth - z.value), -sense * z.slope};
  };
  const ValueSlope beyond = left(last);
  if (beyond.value > 0.0) return never;
  step_ = falling_root(0.0, last, last - beyond.value / beyond.slope, left);
  next_ = course_.end(step_);
  next_.depth = line;
  there_ = local(*cell_, next_);
  crossed_row_ = false;
  // twice what the directions at its ends differ by: no bilinear c bends it back by as much as that
  const double turn = 2.0 * std::abs(there_.c * (tr * next_.zeta - tz * next_.xi));
  return turn < 0.1 ? turn : never;
}

/// Goes from line to line while the ray meets nothing but them and flat boundaries on them: no
/// event is sought. Leaves the ray where anything else may come first. \return false: it has ended
bool March::cross_rows() {
  here_ = local(*cell_, y_);
  while (segments_ < limits_.max_segments) {
    const double tz = here_.c * y_.zeta;
    if (cell_->law == Law::munk || std::abs(tz) < 0.05) break;
    const bool down = tz > 0.0, in_section = cell_->law == Law::bilinear;
    const double line = down ? cell_->row->bottom : cell_->row->top;
    if (line == y_.depth || std::abs(line) > 1e29) break;
    if (line < limits_.min_depth || line > limits_.max_depth) break;
    const bool is_dear = in_section || cell_->law == Law::cubic;
    if (is_dear && (down ? near_bottom_ && stopped_before(line, BoundaryKind::bottom)
                         : near_surface_ && stopped_before(line, BoundaryKind::surface)))
      break;
    const double turn = in_section ? cross_by_series(line) : cross_by_invariant(line);
    if (turn == never) break;
    const bool forward = y_.xi >= 0.0;
    if (forward ? next_.range >= std::min(limits_.max_range, ocean_.column_end(column_))
                : next_.range <= std::max(limits_.min_range, ocean_.column_begin(column_)))
      break;
    if (visitor_ != nullptr && cell_->law == Law::cubic && tells_between(y_.range, next_.range))
      break;
    const double sine = std::min(std::abs(tz), std::abs(there_.c * next_.zeta));
    if (near_surface_) {
      surface_facet_ = facet_ahead(BoundaryKind::surface);
      if (!clear_of(BoundaryKind::surface, sine, turn)) break;
    }
    if (near_bottom_) {
      bottom_facet_ = facet_ahead(BoundaryKind::bottom);
      if (!clear_of(BoundaryKind::bottom, sine, turn)) break;
    }
    creeping_ = false;
    keep();
    y_ = next_;
    const auto kind = down ? BoundaryKind::bottom : BoundaryKind::surface;
    if (on_flat(kind)) {
      if (!reflect_at(kind)) {
        crossed_row_ = false;
        return false;
      }
      if (ocean_.reflection != Reflection::on_the_spot) break;
    } else {
      enter_cell(down ? row_ + 1 : row_ - 1, column_);
      here_ = local(*cell_, y_);
      if (in_section) {
        cross(y_, there_, here_, {.r = 1.0, .z = 0.0});
      } else {  // the same, with c·ξ the cosine
        const double jump = (there_.c_z - here_.c_z) * y_.xi * y_.xi / (there_.c * y_.zeta);
        y_.p += y_.q * jump;
        y_.p_plane += y_.q_plane * jump;
      }
      continue;
    }
    here_ = in_section ? local(*cell_, y_) : there_;
  }
  crossed_row_ = false;
  return true;
}

}  // namespace asdic::detail::tracing
