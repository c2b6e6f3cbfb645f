// The events that end a segment: how far away each is, and where on a step it happens.
#include <algorithm>
#include <cmath>

#include "raytrace/tracing/march.h"

namespace asdic::tracing {
namespace {

constexpr double landed = 1e-9;  // an event is hit within this [m]

}  // namespace

double March::value(Event event, const RayState& y) const noexcept {
  const Environment& sea = ocean_.environment;
  switch (event) {
    case Event::none:
      return 1.0;
    case Event::row_top:
      return y.depth - cell_.row->top;
    case Event::row_bottom:
      return cell_.row->bottom - y.depth;
    case Event::column_begin:
      return y.range - ocean_.column_begin(column_);
    case Event::column_end:
      return ocean_.column_end(column_) - y.range;
    case Event::surface_begin:
      return y.range - sea.surface.shape->facet_begin(surface_facet_);
    case Event::surface_end:
      return sea.surface.shape->facet_end(surface_facet_) - y.range;
    case Event::bottom_begin:
      return y.range - sea.bottom.shape->facet_begin(bottom_facet_);
    case Event::bottom_end:
      return sea.bottom.shape->facet_end(bottom_facet_) - y.range;
    case Event::surface:
      return y.depth - sea.surface.shape->depth_at(y.range, surface_facet_);
    case Event::bottom:
      return sea.bottom.shape->depth_at(y.range, bottom_facet_) - y.depth;
    case Event::turn:
      return y.zeta * turn_sense_ * 1e6;  // of the size of metres
    case Event::least_range:
      return y.range - limits_.min_range;
    case Event::greatest_range:
      return limits_.max_range - y.range;
    case Event::greatest_depth:
      return limits_.max_depth - y.depth;
  }
  return 1.0;
}

/// d(value)/dh.
double March::rate(Event event, const RayState& y) const noexcept {
  const Local at = local(cell_, y);
  const double per_arc = arc_rate(cell_, at.c);
  const double dr = at.c * y.xi * per_arc, dz = at.c * y.zeta * per_arc;
  const auto slope = [&](const BoundaryShape& shape, std::size_t facet) {
    // of the position, which for a curvilinear shape is not that of the tangent
    if (shape.interpolation() == ShapeInterpolation::smooth) return shape.at(y.range, facet).slope;
    return shape.depth_at(y.range + 0.5, facet) - shape.depth_at(y.range - 0.5, facet);
  };
  switch (event) {
    case Event::row_top:
      return dz;
    case Event::row_bottom:
    case Event::greatest_depth:
      return -dz;
    case Event::column_begin:
    case Event::surface_begin:
    case Event::bottom_begin:
    case Event::least_range:
      return dr;
    case Event::column_end:
    case Event::surface_end:
    case Event::bottom_end:
    case Event::greatest_range:
      return -dr;
    case Event::surface:
      return dz - slope(*ocean_.environment.surface.shape, surface_facet_) * dr;
    case Event::bottom:
      return slope(*ocean_.environment.bottom.shape, bottom_facet_) * dr - dz;
    case Event::turn:
      return -at.c_z / (at.c * at.c) * per_arc * turn_sense_ * 1e6;
    case Event::none:
      break;
  }
  return 0.0;
}

/// Brings the end of the step back to where `event` happens, between the steps `low` (value ≥ 0)
/// and `high` (value < 0): regula falsi with halving (Illinois).
void March::shrink_to(Event event, double low, double high) {
  double value_low = value(event, low == 0.0 ? y_ : advance(cell_, y_, low));
  double value_high = value(event, advance(cell_, y_, high));
  if (value_low <= 0.0 && low == 0.0) {  // just left the boundary: find a step that is clear of it
    for (double clear = 0.5 * high; clear > 1e-12 * high; clear *= 0.5) {
      value_low = value(event, advance(cell_, y_, clear));
      low = clear;
      if (value_low > 0.0) break;
      high = clear;
      value_high = value_low;
    }
  }
  double middle = high;
  for (int i = 0, side = 0; i < 200 && value_low > 0.0; ++i) {
    middle = (low * value_high - high * value_low) / (value_high - value_low);
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    const double m = value(event, advance(cell_, y_, middle));
    if (std::abs(m) < landed || high - low < 1e-14 * high) break;
    if (m < 0.0) {
      high = middle;
      value_high = m;
      if (side == 1) value_low *= 0.5;
      side = 1;
    } else {
      low = middle;
      value_low = m;
      if (side == -1) value_high *= 0.5;
      side = -1;
    }
  }
  step_ = middle;
  next_ = advance(cell_, y_, middle);
  event_ = event;
}

/// A step that begins and ends in the water may have dipped into a shaped boundary between.
void March::dipped(Event event) {
  if (!(rate(event, y_) < 0.0 && rate(event, next_) > 0.0)) return;
  double low = 0.0, high = step_;
  RayState lowest = y_;
  for (int i = 0; i < 60 && high - low > 1e-6; ++i) {  // where it comes nearest: rate = 0
    const double middle = 0.5 * (low + high);
    lowest = advance(cell_, y_, middle);
    (rate(event, lowest) < 0.0 ? low : high) = middle;
    if (value(event, lowest) < 0.0) return shrink_to(event, 0.0, middle);
  }
}

/// The first thing that happens on the step.
void March::find_events() {
  const auto check = [&](Event event) {
    if (event == event_) return;
    if (value(event, next_) < -landed) shrink_to(event, 0.0, step_);
  };
  if (turn_sense_ != 0.0 && cell_.law == Law::general) check(Event::turn);
  check(Event::row_top);
  check(Event::row_bottom);
  if (ocean_.environment.section) {
    check(Event::column_begin);
    check(Event::column_end);
  }
  if (near_surface_) {
    check(Event::surface_begin);
    check(Event::surface_end);
    check(Event::surface);
    if (event_ != Event::surface) dipped(Event::surface);
  }
  if (near_bottom_) {
    check(Event::bottom_begin);
    check(Event::bottom_end);
    check(Event::bottom);
    if (event_ != Event::bottom) dipped(Event::bottom);
  }
  check(Event::least_range);
  check(Event::greatest_range);
  check(Event::greatest_depth);
}

}  // namespace asdic::tracing
