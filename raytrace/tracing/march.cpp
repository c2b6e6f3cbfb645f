#include "raytrace/tracing/march.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail::tracing {
namespace {

constexpr int most_touches = 32;
constexpr int most_turns = 20'000;  // along a kink of the profile

}  // namespace

void March::run(double source_range, double source_depth, double launch_elevation) {
  out_.segments.clear();
  out_.bounces.clear();
  out_.launch_elevation = launch_elevation;
  source_range_ = source_range;
  y_ = {.range = source_range, .depth = source_depth};
  enter_cell(ocean_.row(source_depth), ocean_.column(source_range));
  const double c = cell_->speed(y_.range, y_.depth).c;
  out_.source_speed = c;
  double cosine = std::cos(launch_elevation), sine = std::sin(launch_elevation);
  if (std::abs(cosine) < 1e-15) cosine = 0.0;  // straight up or down: π/2 has no exact number
  if (std::abs(sine) < 1e-15) sine = 0.0;
  y_.xi = cosine / c;
  y_.zeta = -sine / c;
  y_.p = 1.0 / c;
  if (y_.xi < 0.0 && source_range == ocean_.column_begin(column_)) enter_cell(row_, column_ - 1);
  enter(source_depth);
  while (cross_rows() && begin_step()) {
    if (creeping_) {
      creep();
    } else {
      plan();
    }
    snap();
    record();
    y_ = next_;
    if (!answer()) return;
  }
}

void March::enter_cell(std::size_t row, std::size_t column) {
  row_ = row;
  column_ = column;
  cell_ = &ocean_.cell(row, column);
  near_surface_ = cell_->row->near_surface;
  near_bottom_ = cell_->row->near_bottom;
}

/// The row for a ray at a depth: on a line, the one it is heading for.
void March::enter(double depth) {
  std::size_t row = ocean_.row(depth);
  if (ocean_.rows[row].top == depth && row > 0) {
    if (y_.zeta != 0.0) {
      if (y_.zeta < 0.0) --row;
    } else if (ocean_.cell(row, column_).speed(y_.range, depth).c_z > 0.0) {
      --row;  // horizontal on a line: dζ/ds = −c_z/c² on either side
    }
  }
  enter_cell(row, column_);
}

/// The facet over or under the ray: at a node the one it is heading for.
std::size_t March::facet_ahead(BoundaryKind kind) const noexcept {
  std::size_t i = facet(kind);
  const Facet& last = wall(kind).facets[i];
  if (y_.range > last.begin && y_.range < last.end) return i;
  const BoundaryShape& shape = *boundary(kind).shape;
  i = shape.facet(y_.range);
  if (y_.xi < 0.0 && i > 0 && shape.facet_begin(i) == y_.range) --i;
  return i;
}

/// Whether the ray is on a boundary and about to leave the water.
bool March::meets(BoundaryKind kind, double heading) const {
  const bool above = kind == BoundaryKind::surface;
  if (above ? !near_surface_ : !near_bottom_)
    return on_flat(kind) && (above ? heading < 0.0 : heading > 0.0) && y_.zeta != 0.0;
  const std::size_t i = facet(kind);
  const double sense = above ? 1.0 : -1.0;
  const BoundaryShape& shape = *boundary(kind).shape;
  if (sense * (y_.depth - shape.depth_at(y_.range, i)) > 1e-12) return false;
  const Line& line = wall(kind).facets[i].line;
  // of the position, which for a curvilinear shape is not that of the tangent
  const double slope = wall(kind).straight ? -line.nr / line.nz : shape.at(y_.range, i).slope;
  return sense * (y_.zeta - slope * y_.xi) < 0.0;
}

/// Looks at where the ray is and deals with what happens on the spot; false when the ray has ended.
bool March::begin_step() {
  for (;;) {
    if (segments_ >= limits_.max_segments ||
        history_.upper_turns + history_.lower_turns >= most_turns)
      return end(RayEnd::trapped);
    here_ = local(*cell_, y_);
    if (near_surface_) surface_facet_ = facet_ahead(BoundaryKind::surface);
    if (near_bottom_) bottom_facet_ = facet_ahead(BoundaryKind::bottom);
    const double heading = y_.zeta != 0.0 ? y_.zeta : -here_.c_z;  // dζ/ds = −c_z/c²
    const bool surface = meets(BoundaryKind::surface, heading);
    if (!surface && !meets(BoundaryKind::bottom, heading)) break;
    const auto kind = surface ? BoundaryKind::surface : BoundaryKind::bottom;
    if (++touches_ > most_touches) return end(RayEnd::trapped);
    if (!reflect_at(kind)) return false;
    if (on_flat(kind)) enter(y_.depth);
  }
  creeping_ = y_.zeta == 0.0 && ((y_.depth == cell_->row->bottom && here_.c_z < 0.0) ||
                                 (y_.depth == cell_->row->top && here_.c_z > 0.0));
  return true;
}

/// A horizontal ray that the water on both sides of a line bends back to it stays on the line.
void March::creep() {
  const bool forward = y_.xi > 0.0;
  const double wall = forward ? limits_.max_range : limits_.min_range;
  const double edge = forward ? ocean_.column_end(column_) : ocean_.column_begin(column_);
  const double way = std::abs((forward ? std::min(wall, edge) : std::max(wall, edge)) - y_.range);
  step_ = std::min(way, longest_segment);
  event_ = Event::none;
  if (way <= longest_segment) {
    const bool ends = forward ? wall <= edge : wall >= edge;
    if (forward) event_ = ends ? Event::greatest_range : Event::column_end;
    if (!forward) event_ = ends ? Event::least_range : Event::column_begin;
  }
  here_.c_r = here_.c_z = here_.c_nn = 0.0;
  next_ = crept(step_);
}

RayState March::crept(double way) const {
  RayState y = y_;
  y.range += std::copysign(way, y_.xi);
  y.time += way / here_.c;
  y.q += y_.p * here_.c * way;
  y.q_plane += y_.p_plane * here_.c * way;
  y.nepers += cell_->row->alpha(y_.depth) * way;
  y.length += way;
  y.speed_integral += here_.c * way;
  return y;
}

/// Puts the ray exactly on what it met.
void March::snap() {
  const Environment& sea = ocean_.environment;
  switch (event_) {
    case Event::row_top:
      next_.depth = cell_->row->top;
      break;
    case Event::row_bottom:
      next_.depth = cell_->row->bottom;
      break;
    case Event::column_begin:
      next_.range = ocean_.column_begin(column_);
      break;
    case Event::column_end:
      next_.range = ocean_.column_end(column_);
      break;
    case Event::surface:
      next_.depth = sea.surface.shape->depth_at(next_.range, surface_facet_);
      break;
    case Event::bottom:
      next_.depth = sea.bottom.shape->depth_at(next_.range, bottom_facet_);
      break;
    case Event::turn:
      next_.zeta = 0.0;
      break;
    case Event::least_range:
      next_.range = limits_.min_range;
      break;
    case Event::greatest_range:
      next_.range = limits_.max_range;
      break;
    case Event::least_depth:
    case Event::greatest_depth:
    case Event::none:
      break;
  }
  if (event_ == Event::turn) {  // |slowness| = 1/c, come what may
    const double c = cell_->speed(next_.range, next_.depth).c;
    next_.xi = std::copysign(1.0 / c, next_.xi);
  }
}

void March::record() {
  there_ = creeping_ ? here_ : local(*cell_, next_);
  keep();
}

void March::keep() {
  ++segments_;
  if (visitor_ == nullptr)
    store();
  else
    tell_ranges();
  if (next_.q * sense_ < 0.0) {  // a caustic
    ++history_.caustics;
    sense_ = -sense_;
  }
  if (next_.length - y_.length > 1e-6) touches_ = 0;
}

void March::store() {
  RaySegment& s = out_.segments.emplace_back(y_, next_, history_);
  s.c_begin = here_.c;
  s.c_end = there_.c;
  s.c_r_begin = here_.c_r;
  s.c_z_begin = here_.c_z;
  s.c_r_end = there_.c_r;
  s.c_z_end = there_.c_z;
  s.c_nn_begin = here_.c_nn;
  s.c_nn_end = there_.c_nn;
  s.alpha_begin = cell_->row->alpha(y_.depth);
  s.alpha_end = cell_->row->alpha(next_.depth);
  s.row = static_cast<std::uint32_t>(row_);
  s.column = static_cast<std::uint32_t>(column_);
}

/// A segment owns its begin, not its end.
void March::tell_ranges() {
  const double from = y_.range, to = next_.range;
  if (from == to) return;
  if (crossed_row_) course_.begin(*cell_, y_, here_);
  const auto tell = [&](std::size_t i) {
    const RayState y = passing(ranges_[i]);
    RayHistory history = history_;
    if (y.q * sense_ < 0.0) ++history.caustics;
    visitor_->pass(i, y, history);
  };
  std::size_t& i = next_range_;
  if (to > from) {
    while (i > 0 && ranges_[i - 1] >= from) --i;
    while (i < ranges_.size() && ranges_[i] < from) ++i;
    while (i < ranges_.size() && ranges_[i] < to) tell(i++);
  } else {
    while (i > 0 && ranges_[i - 1] > from) --i;
    while (i < ranges_.size() && ranges_[i] <= from) ++i;
    while (i > 0 && ranges_[i - 1] > to) tell(--i);
  }
}

bool March::tells_between(double from, double to) const {
  if (visitor_ == nullptr) return false;
  const double low = std::min(from, to), high = std::max(from, to);
  const auto i = std::lower_bound(ranges_.begin(), ranges_.end(), low);
  return i != ranges_.end() && *i <= high;
}

RayState March::passing(double range) const {
  RayState y =
      creeping_
          ? crept(std::abs(range - y_.range))
          : course_.end(std::min(course_.to_range(range, y_.range, next_.range, step_), step_));
  y.range = range;
  return y;
}

/// What follows from the event; false when the ray has ended.
bool March::answer() {
  constexpr Tangent level{.r = 1.0, .z = 0.0}, upright{.r = 0.0, .z = 1.0};
  const auto into = [&](std::size_t row, std::size_t column, const Tangent& line) {
    const Local before = creeping_ ? local(*cell_, y_) : there_;
    enter_cell(row, column);
    cross(y_, before, local(*cell_, y_), line);
    return true;
  };
  switch (event_) {
    case Event::row_top:
      if (on_flat(BoundaryKind::surface)) return reflect_at(BoundaryKind::surface);
      return into(row_ - 1, column_, level);
    case Event::row_bottom:
      if (on_flat(BoundaryKind::bottom)) return reflect_at(BoundaryKind::bottom);
      return into(row_ + 1, column_, level);
    case Event::column_begin:
      return into(row_, column_ - 1, upright);
    case Event::column_end:
      return into(row_, column_ + 1, upright);
    case Event::surface:
      return reflect_at(BoundaryKind::surface);
    case Event::bottom:
      return reflect_at(BoundaryKind::bottom);
    case Event::turn:
      ++(rising_ ? history_.upper_turns : history_.lower_turns);
      return true;
    case Event::least_range:
    case Event::greatest_range:
    case Event::least_depth:
    case Event::greatest_depth:
      return end(RayEnd::box);
    case Event::none:
      break;
  }
  return true;
}

}  // namespace asdic::detail::tracing
