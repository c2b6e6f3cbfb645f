#include "raytrace/tracing/march.h"

#include <algorithm>
#include <cmath>

namespace asdic::tracing {
namespace {

constexpr double widest_turn = 0.3;   // of the direction within one segment [rad]
constexpr double longest_step = 2e4;  // [m]
constexpr int most_touches = 32;

}  // namespace

void March::run(double source_range, double source_depth, double launch_elevation) {
  out_.segments.clear();
  out_.bounces.clear();
  out_.launch_elevation = launch_elevation;
  source_range_ = source_range;
  y_ = {.range = source_range, .depth = source_depth};
  column_ = ocean_.column(source_range);
  row_ = ocean_.row(source_depth);
  const double c = ocean_.cell(row_, column_).speed(y_.range, y_.depth).c;
  out_.source_speed = c;
  double cosine = std::cos(launch_elevation), sine = std::sin(launch_elevation);
  if (std::abs(cosine) < 1e-15) cosine = 0.0;  // straight up or down: π/2 has no exact number
  if (std::abs(sine) < 1e-15) sine = 0.0;
  y_.xi = cosine / c;
  y_.zeta = -sine / c;
  y_.p = 1.0 / c;
  if (y_.xi < 0.0 && source_range == ocean_.column_begin(column_)) --column_;
  enter(source_depth);
  while (begin_step()) {
    if (creeping_) {
      creep();
    } else {
      plan();
      find_events();
    }
    snap();
    record();
    y_ = next_;
    if (!answer()) return;
  }
}

/// The row for a ray at a depth: on a line, the one it is heading for.
void March::enter(double depth) {
  row_ = ocean_.row(depth);
  if (ocean_.rows[row_].top != depth || row_ == 0) return;
  if (y_.zeta != 0.0) {
    if (y_.zeta < 0.0) --row_;
    return;
  }
  // horizontal on a line: dζ/ds = −c_z/c² on either side
  if (ocean_.cell(row_, column_).speed(y_.range, depth).c_z > 0.0) --row_;
}

bool March::on_flat(BoundaryKind kind) const noexcept {
  return !boundary(kind).shape && y_.depth == boundary(kind).depth;
}

/// Looks at where the ray is and deals with what happens on the spot; false when the ray has ended.
bool March::begin_step() {
  if (out_.segments.size() >= std::size_t(limits_.max_segments)) return end(RayEnd::trapped);
  cell_ = ocean_.cell(row_, column_);
  here_ = local(cell_, y_);
  const Environment& sea = ocean_.environment;
  near_surface_ = ocean_.near_surface(row_);
  near_bottom_ = ocean_.near_bottom(row_);
  const auto facet_ahead = [&](const BoundaryShape& shape) {
    std::size_t facet = shape.facet(y_.range);
    if (y_.xi < 0.0 && facet > 0 && shape.facet_begin(facet) == y_.range) --facet;
    return facet;
  };
  if (near_surface_) surface_facet_ = facet_ahead(*sea.surface.shape);
  if (near_bottom_) bottom_facet_ = facet_ahead(*sea.bottom.shape);
  const double heading = y_.zeta != 0.0 ? y_.zeta : -here_.c_z;  // dζ/ds = −c_z/c²
  for (const auto kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
    const bool above = kind == BoundaryKind::surface;
    bool leaves = on_flat(kind) && (above ? heading < 0.0 : heading > 0.0) && y_.zeta != 0.0;
    if (above ? near_surface_ : near_bottom_) {
      const Event event = above ? Event::surface : Event::bottom;
      leaves = value(event, y_) <= 1e-12 && rate(event, y_) < 0.0;
    }
    if (!leaves) continue;
    if (++touches_ > most_touches) return end(RayEnd::trapped);
    if (!reflect_at(kind)) return false;
    if (on_flat(kind)) enter(y_.depth);
    return begin_step();
  }
  creeping_ = y_.zeta == 0.0 && ((y_.depth == cell_.row->bottom && here_.c_z < 0.0) ||
                                 (y_.depth == cell_.row->top && here_.c_z > 0.0));
  turn_sense_ = y_.zeta > 0.0 ? 1.0 : y_.zeta < 0.0 ? -1.0 : 0.0;
  return true;
}

/// A horizontal ray that the water on both sides of a line bends back to it stays on the line.
void March::creep() {
  const bool forward = y_.xi > 0.0;
  const double wall = forward ? limits_.max_range : limits_.min_range;
  const double edge = forward ? ocean_.column_end(column_) : ocean_.column_begin(column_);
  const double way = std::abs((forward ? std::min(wall, edge) : std::max(wall, edge)) - y_.range);
  step_ = std::min(way, longest_step);
  event_ = Event::none;
  if (way <= longest_step) {
    const bool ends = forward ? wall <= edge : wall >= edge;
    if (forward) event_ = ends ? Event::greatest_range : Event::column_end;
    if (!forward) event_ = ends ? Event::least_range : Event::column_begin;
  }
  here_.c_r = here_.c_z = here_.c_nn = 0.0;
  next_ = y_;
  next_.range += std::copysign(step_, y_.xi);
  next_.time += step_ / here_.c;
  next_.q += y_.p * here_.c * step_;
  next_.q_plane += y_.p_plane * here_.c * step_;
  next_.nepers += cell_.row->alpha(y_.depth) * step_;
  next_.length += step_;
}

/// Chooses the step and takes it: next_, step_ and event_ if it is known which ends it.
void March::plan() {
  event_ = Event::none;
  const Row& row = *cell_.row;
  const bool down = y_.zeta > 0.0 || (y_.zeta == 0.0 && here_.c_z < 0.0);
  const double to_line = step_to_depth(cell_, y_, down ? row.bottom : row.top);
  const double to_turn = step_to_turn(cell_, y_);
  double step = std::min(to_line, to_turn);
  const Event expected = to_turn <= to_line ? Event::turn
                         : down             ? Event::row_bottom
                                            : Event::row_top;
  const double bend = std::abs(-here_.c_r * y_.zeta + here_.c_z * y_.xi);  // |c_n|/c
  const double scale = cell_.law == Law::parabola ? here_.c : 1.0;
  const double longest = std::min(longest_step, bend > 0.0 ? widest_turn / bend : never) * scale;
  // a range that ends the ray or the column shortens a step that would run far beyond it
  const double far_end = y_.xi > 0.0 ? std::min({limits_.max_range, ocean_.column_end(column_)})
                                     : std::max({limits_.min_range, ocean_.column_begin(column_)});
  const double speed_r = here_.c * y_.xi;
  const double to_end =
      speed_r != 0.0 ? 1.05 * (far_end - y_.range) / speed_r * scale + 1.0 : never;
  if (step <= std::min(longest, to_end)) event_ = expected;
  step_ = std::min({step, longest, to_end});
  if (cell_.law != Law::general) {
    next_ = advance(cell_, y_, step_);
    return;
  }
  take_general_step();
}

/// A step of the general law under error control; one planned to end on a line or at a turning
/// point is corrected until it does, when it comes near.
void March::take_general_step() {
  if (step_ > general_step_) {
    step_ = general_step_;
    event_ = Event::none;
  }
  double error = 0.0;
  next_ = advance(cell_, y_, step_, &error);
  for (int i = 0; error > 1.0 && i < 40; ++i) {
    step_ *= std::clamp(0.9 * std::pow(error, -0.2), 0.1, 0.9);
    event_ = Event::none;
    next_ = advance(cell_, y_, step_, &error);
  }
  if (event_ == Event::none || step_ >= general_step_)
    general_step_ = step_ * std::clamp(0.9 * std::pow(error + 1e-12, -0.2), 0.5, 3.0);
  general_step_ = std::clamp(general_step_, 1e-3, longest_step);
  if (event_ == Event::none) return;
  for (int i = 0; i < 6; ++i) {  // Newton's method on the step
    const double miss = value(event_, next_);
    const double closing = rate(event_, next_);
    const double correction = closing < 0.0 ? -miss / closing : never;
    if (std::abs(correction) > 0.25 * step_) {  // not near: an ordinary step, found_events looks
      event_ = Event::none;
      return;
    }
    if (std::abs(correction) < 1e-10 * (1.0 + step_)) return;
    step_ += correction;
    next_ = advance(cell_, y_, step_);
  }
}

/// Puts the ray exactly on what it met.
void March::snap() {
  const Environment& sea = ocean_.environment;
  switch (event_) {
    case Event::row_top:
      next_.depth = cell_.row->top;
      break;
    case Event::row_bottom:
      next_.depth = cell_.row->bottom;
      break;
    case Event::column_begin:
      next_.range = ocean_.column_begin(column_);
      break;
    case Event::column_end:
      next_.range = ocean_.column_end(column_);
      break;
    case Event::surface_begin:
      next_.range = sea.surface.shape->facet_begin(surface_facet_);
      break;
    case Event::surface_end:
      next_.range = sea.surface.shape->facet_end(surface_facet_);
      break;
    case Event::bottom_begin:
      next_.range = sea.bottom.shape->facet_begin(bottom_facet_);
      break;
    case Event::bottom_end:
      next_.range = sea.bottom.shape->facet_end(bottom_facet_);
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
    case Event::greatest_depth:
    case Event::none:
      break;
  }
  if (event_ == Event::turn || cell_.law == Law::general) {  // |slowness| = 1/c, come what may
    const double c = cell_.speed(next_.range, next_.depth).c;
    const double scale = 1.0 / (c * std::hypot(next_.xi, next_.zeta));
    next_.xi *= scale;
    next_.zeta *= scale;
  }
}

void March::record() {
  const Local there = creeping_ ? here_ : local(cell_, next_);
  out_.segments.push_back({.begin = y_,
                           .end = next_,
                           .history = history_,
                           .c_begin = here_.c,
                           .c_end = there.c,
                           .c_r_begin = here_.c_r,
                           .c_z_begin = here_.c_z,
                           .c_r_end = there.c_r,
                           .c_z_end = there.c_z,
                           .c_nn_begin = here_.c_nn,
                           .c_nn_end = there.c_nn,
                           .alpha_begin = cell_.row->alpha(y_.depth),
                           .alpha_end = cell_.row->alpha(next_.depth)});
  if (next_.q * sense_ < 0.0) {  // a caustic
    ++history_.caustics;
    sense_ = -sense_;
  }
  if (next_.length - y_.length > 1e-6) touches_ = 0;
}

/// What follows from the event; false when the ray has ended.
bool March::answer() {
  constexpr Tangent level{.r = 1.0, .z = 0.0}, upright{.r = 0.0, .z = 1.0};
  const auto into_row = [&](std::size_t row) {
    const Local before = local(cell_, y_);
    row_ = row;
    cross(y_, before, local(ocean_.cell(row_, column_), y_), level);
    return true;
  };
  const auto into_column = [&](std::size_t column) {
    const Local before = local(cell_, y_);
    column_ = column;
    cross(y_, before, local(ocean_.cell(row_, column_), y_), upright);
    return true;
  };
  switch (event_) {
    case Event::row_top:
      if (on_flat(BoundaryKind::surface)) return reflect_at(BoundaryKind::surface);
      return into_row(row_ - 1);
    case Event::row_bottom:
      if (on_flat(BoundaryKind::bottom)) return reflect_at(BoundaryKind::bottom);
      return into_row(row_ + 1);
    case Event::column_begin:
      return into_column(column_ - 1);
    case Event::column_end:
      return into_column(column_ + 1);
    case Event::surface:
      return reflect_at(BoundaryKind::surface);
    case Event::bottom:
      return reflect_at(BoundaryKind::bottom);
    case Event::turn:
      ++(turn_sense_ < 0.0 ? history_.upper_turns : history_.lower_turns);
      return true;
    case Event::least_range:
    case Event::greatest_range:
    case Event::greatest_depth:
      return end(RayEnd::box);
    case Event::surface_begin:
    case Event::surface_end:
    case Event::bottom_begin:
    case Event::bottom_end:
    case Event::none:
      break;
  }
  return true;
}

Tangent March::tangent_at(BoundaryKind kind) const noexcept {
  const Boundary& wall = boundary(kind);
  if (!wall.shape) return {};
  const std::size_t facet = kind == BoundaryKind::surface ? surface_facet_ : bottom_facet_;
  const BoundaryPoint point = wall.shape->at(y_.range, facet);
  const double length = std::hypot(1.0, point.slope);
  return {.r = 1.0 / length, .z = point.slope / length, .curvature = point.curvature};
}

bool March::reflect_at(BoundaryKind kind) {
  const bool surface = kind == BoundaryKind::surface;
  const Boundary& wall = boundary(kind);
  int& bounces = surface ? history_.surface_bounces : history_.bottom_bounces;
  if (bounces >= (surface ? limits_.max_surface_bounces : limits_.max_bottom_bounces))
    return end(RayEnd::bounces);
  const Local water = local(ocean_.cell(row_, column_), y_);
  Tangent tangent = tangent_at(kind);
  const RayState in = y_;
  RayState out = y_;
  double grazing = reflect(out, water, tangent);
  if (wall.shape && wall.shape->interpolation() == ShapeInterpolation::curvilinear) {
    // the turned tangent may send a grazing ray through the facet: then the facet itself reflects
    const std::size_t facet = surface ? surface_facet_ : bottom_facet_;
    const double slope =
        wall.shape->depth_at(y_.range + 0.5, facet) - wall.shape->depth_at(y_.range - 0.5, facet);
    const double away = (out.zeta - slope * out.xi) * (surface ? 1.0 : -1.0);
    if (away <= 0.0) {
      tangent = {.r = 1.0 / std::hypot(1.0, slope), .z = slope / std::hypot(1.0, slope)};
      out = y_;
      grazing = reflect(out, water, tangent);
    }
  }
  y_ = out;
  ++bounces;
  const BoundaryMaterial* material = &wall.material;
  if (wall.shape && !wall.shape->materials().empty()) {
    const std::size_t facet = surface ? surface_facet_ : bottom_facet_;
    material = &wall.shape->materials()[facet == 0 ? 0 : facet - 1];
  }
  const WaterAtBoundary beside{.speed = water.c,
                               .density = ocean_.environment.water_density.at(y_.depth)};
  const std::complex<double> coefficient = reflection_coefficient(*material, grazing, beside);
  out_.bounces.push_back({.boundary = kind, .grazing = grazing, .range = y_.range - source_range_});
  history_.reflection *= coefficient;
  history_.reflection_phase += std::arg(coefficient);
  const double left = std::abs(history_.reflection);
  if (left == 0.0) return end(RayEnd::absorbed);
  if (left < limits_.faintest) return end(RayEnd::faint);
  if (ocean_.reflection == Reflection::on_the_spot) return true;
  return displace_along(kind, in, water, tangent,
                        beam_displacement(*material, grazing, beside, ocean_.frequency));
}

}  // namespace asdic::tracing
