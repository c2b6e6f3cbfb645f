// The event that ends a segment: which comes first, and where on the ray's course.
#include <algorithm>
#include <cmath>

#include "raytrace/tracing/march.h"

namespace asdic::detail::tracing {
namespace {

constexpr double landed = 1e-9;  // an event is hit within this [m]

}  // namespace

/// Chooses the step and takes it: next_, step_ and event_, what ends it.
void March::plan() {
  course_.begin(*cell_, y_, here_);
  event_ = Event::none;
  rising_ = y_.zeta < 0.0;
  const bool down = y_.zeta > 0.0 || (y_.zeta == 0.0 && here_.c_z < 0.0);
  const double bend = std::abs(-here_.c_r * y_.zeta + here_.c_z * y_.xi);  // |c_n|/c
  const double longest =
      course_.per_metre() *
      (bend * longest_segment > widest_turn ? widest_turn / bend : longest_segment);
  if (course_.closed())
    plan_closed(down, longest);
  else
    plan_series(down, longest);
  if (near_surface_) strike(BoundaryKind::surface);
  if (near_bottom_) strike(BoundaryKind::bottom);
  next_ = course_.end(step_);
}

/// Arcs and parabolas tell where they meet a line.
void March::plan_closed(bool down, double longest) {
  const Row& row = *cell_->row;
  step_ = longest;
  const auto take = [&](Event event, double step) {
    if (step > step_) return;
    step_ = std::max(step, 0.0);
    event_ = event;
  };
  take(down ? Event::row_bottom : Event::row_top,
       course_.to_line({.depth = down ? row.bottom : row.top, .nz = down ? -1.0 : 1.0}));
  take(Event::turn, course_.to_turn());
  // no further than this; c within a segment, turned by 0.3 rad, is within 5 % of here
  const double within = 1.1 * step_ / course_.per_metre();
  const bool forward = y_.xi > 0.0;
  const auto take_range = [&](Event event, double range) {
    if (std::abs(range - y_.range) <= within) take(event, step_to_range(range, forward));
  };
  if (forward) {
    take_range(Event::column_end, ocean_.column_end(column_));
    take_range(Event::greatest_range, limits_.max_range);
  } else if (y_.xi < 0.0) {
    take_range(Event::column_begin, ocean_.column_begin(column_));
    take_range(Event::least_range, limits_.min_range);
  }
  if (y_.depth - limits_.min_depth <= within)
    take(Event::least_depth, course_.to_line({.depth = limits_.min_depth, .nz = 1.0}));
  if (limits_.max_depth - y_.depth <= within)
    take(Event::greatest_depth, course_.to_line({.depth = limits_.max_depth, .nz = -1.0}));
}

/// The travel time to the row's line or the turning point ahead, by the ray's present bend; in
/// range no further than where the column or the ray ends.
double March::guess(bool down) const {
  const double c = here_.c, tr = c * y_.xi, tz = c * y_.zeta;
  const double bend = (here_.c_r * tz - here_.c_z * tr) / c * tr;  // z″ = −(c_n/c)·t_r
  const double dz = (down ? cell_->row->bottom : cell_->row->top) - y_.depth;
  const double square = tz * tz + 2.0 * bend * dz;
  double way = square < 0.0 ? -tz / bend : 2.0 * dz / (tz + std::copysign(std::sqrt(square), dz));
  if (!(way >= 0.0)) way = longest_segment;
  const double wall = tr > 0.0 ? std::min(limits_.max_range, ocean_.column_end(column_))
                               : std::max(limits_.min_range, ocean_.column_begin(column_));
  if (tr != 0.0) way = std::min(way, (wall - y_.range) / tr);
  return (way + 1.0) / c;
}

/// No further than to the facet ahead and a little more, if that is where a straight ray goes [s].
double March::to_facet_ahead(BoundaryKind kind, double time) const {
  const double c = here_.c, tr = c * y_.xi, tz = c * y_.zeta;
  const Facet& f = wall(kind).facets[facet(kind)];
  const double closing = -(f.line.nr * tr + f.line.nz * tz);
  const double way = std::max(f.line.distance(y_.range, y_.depth), 0.0) / closing;
  const double range = y_.range + way * tr;
  if (!(closing > 0.05) || range < f.begin || range > f.end) return time;
  return std::min(time, (1.1 * way + 10.0) / c);
}

/// A power series tells where it is: what it has passed at the end of the step, it met before.
void March::plan_series(bool down, double longest) {
  const Row& row = *cell_->row;
  double wanted = std::min(longest, 1.2 * guess(down));
  if (down && near_bottom_) wanted = to_facet_ahead(BoundaryKind::bottom, wanted);
  if (!down && near_surface_) wanted = to_facet_ahead(BoundaryKind::surface, wanted);
  course_.expand(wanted);
  step_ = course_.reach();
  const double sense = y_.zeta > 0.0 ? 1.0 : -1.0;
  if (y_.zeta != 0.0 && sense * course_.rise(step_).value < 0.0) {
    event_ = Event::turn;
    step_ = falling_root(0.0, step_, step_, [&](double h) {
      const auto rise = course_.rise(h);
      return ValueSlope{sense * rise.value, sense * rise.slope};
    });
  }
  if (cell_->law == Law::bilinear) {  // range is to grow or to fall all along
    const double dr = course_.at(0.0).dr, sign = std::copysign(1.0, dr);
    if (std::abs(dr) > 1e-9 * here_.c && sign * course_.at(step_).dr < 0.0) {
      event_ = Event::none;
      step_ = falling_root(0.0, step_, step_, [&](double h) {
        const auto advance = course_.advance(h);
        return ValueSlope{sign * advance.value, sign * advance.slope};
      });
    }
  }
  Place end = course_.at(step_);
  const auto cut = [&](Event event, const Line& line, double beyond) {
    event_ = event;
    const double before = std::max(line.distance(y_.range, y_.depth), 0.0);
    const double guess = step_ * before / (before + beyond);  // where the chord meets it
    step_ = falling_root(0.0, step_, guess > 0.0 ? guess : step_, [&](double h) {
      const Place p = course_.at(h);
      return ValueSlope{line.distance(p.range, p.depth), line.nr * p.dr + line.nz * p.dz};
    });
    end = course_.at(step_);
  };
  // All lines are looked at, few are passed: without a call, as most numbers of a line are 0 or 1.
  const auto take = [&](Event event, const Line& line) __attribute__((always_inline)) {
    const double beyond = -line.distance(end.range, end.depth);
    if (!(beyond <= 0.0)) cut(event, line, beyond);
  };
  const auto in_front = [](double range) { return Line{.range = range, .nr = -1.0, .nz = 0.0}; };
  const auto behind = [](double range) { return Line{.range = range, .nr = 1.0, .nz = 0.0}; };
  take(Event::row_top, {.depth = row.top, .nz = 1.0});
  take(Event::row_bottom, {.depth = row.bottom, .nz = -1.0});
  if (cell_->law == Law::bilinear) {
    take(Event::column_begin, behind(ocean_.column_begin(column_)));
    take(Event::column_end, in_front(ocean_.column_end(column_)));
  }
  take(Event::least_range, behind(limits_.min_range));
  take(Event::greatest_range, in_front(limits_.max_range));
  take(Event::least_depth, {.depth = limits_.min_depth, .nz = 1.0});
  take(Event::greatest_depth, {.depth = limits_.max_depth, .nz = -1.0});
}

double March::step_to_range(double range, bool forward) const {
  const Line line{.range = range, .nr = forward ? -1.0 : 1.0, .nz = 0.0};
  if (course_.closed()) return course_.to_line(line);
  return falling_root(0.0, step_, step_, [&](double h) {
    const Place p = course_.at(h);
    return ValueSlope{line.distance(p.range, p.depth), line.nr * p.dr};
  });
}

/// Ends the step where it first meets a shaped boundary, facet after facet along its way. Within a
/// segment depth grows or falls all along, so its ends bound it.
void March::strike(BoundaryKind kind) {
  const bool above = kind == BoundaryKind::surface;
  const auto& facets = wall(kind).facets;
  const Place end = course_.at(step_);
  const double shallow = std::min(y_.depth, end.depth), deep = std::max(y_.depth, end.depth);
  const bool forward = end.range >= y_.range;
  const std::size_t first = facet(kind);
  for (std::size_t i = first;; forward ? ++i : --i) {
    const Facet& f = facets[i];
    const bool last = forward ? end.range <= f.end : end.range >= f.begin;
    const bool clear = above ? f.extreme < shallow - landed : f.extreme > deep + landed;
    if (!clear) {
      const double in = i == first ? 0.0 : step_to_range(forward ? f.begin : f.end, forward);
      const double out = last ? step_ : step_to_range(forward ? f.end : f.begin, forward);
      const double h = hit(kind, i, std::clamp(in, 0.0, step_), std::clamp(out, 0.0, step_));
      if (h < never) {
        step_ = h;
        event_ = above ? Event::surface : Event::bottom;
        (above ? surface_facet_ : bottom_facet_) = i;
        return;
      }
    }
    if (last) return;
  }
}

/// Distance from a facet along its normal; of a smooth one, in depth.
ValueSlope March::clearance(BoundaryKind kind, std::size_t facet, double h) const {
  const Place p = course_.at(h);
  const Line& line = wall(kind).facets[facet].line;
  if (wall(kind).straight)
    return {line.distance(p.range, p.depth), line.nr * p.dr + line.nz * p.dz};
  const BoundaryPoint point = boundary(kind).shape->at(p.range, facet);
  const double sense = kind == BoundaryKind::surface ? 1.0 : -1.0;
  return {sense * (p.depth - point.depth), sense * (p.dz - point.slope * p.dr)};
}

/// Where the course meets a facet between two steps; infinity if it does not.
double March::hit(BoundaryKind kind, std::size_t facet, double in, double out) const {
  const bool closed = course_.closed() && wall(kind).straight;
  const ValueSlope begin = clearance(kind, facet, in), end = clearance(kind, facet, out);
  if (begin.value <= 1e-12 && begin.slope < 0.0) return in;
  const bool passes = end.value < -landed, dips = begin.slope < 0.0 && end.slope > 0.0;
  if (!passes && !dips) return never;
  if (closed) {
    const double h = course_.to_line(wall(kind).facets[facet].line);
    if (h >= in && h <= out) return h;
    if (!passes) return never;
  }
  if (passes) return hit_between(kind, facet, in, out);
  // down and up again: by the tangents at its ends it stays above this
  const double cut =
      (end.value - begin.value + begin.slope * in - end.slope * out) / (begin.slope - end.slope);
  if (begin.value + begin.slope * (cut - in) > 0.0) return never;
  double low = in, high = out;
  for (int i = 0; i < 60 && high - low > 1e-9 * out; ++i) {  // where it comes nearest
    const double middle = 0.5 * (low + high);
    const ValueSlope there = clearance(kind, facet, middle);
    if (there.value < 0.0) return hit_between(kind, facet, in, middle);
    (there.slope < 0.0 ? low : high) = middle;
  }
  return never;
}

/// The same when it is clear of the facet at the first of them, or has just left it, and behind it
/// at the second.
double March::hit_between(BoundaryKind kind, std::size_t facet, double in, double out) const {
  double low = in;
  if (clearance(kind, facet, in).value <= 0.0) {
    double clear = 0.5 * (out - in);
    while (clear > 1e-12 * out) {
      low = in + clear;
      if (clearance(kind, facet, low).value > 0.0) break;
      out = low;
      clear *= 0.5;
    }
  }
  return falling_root(low, out, out, [&](double h) { return clearance(kind, facet, h); });
}

}  // namespace asdic::detail::tracing
