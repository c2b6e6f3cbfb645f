#include "raytrace/tracing/ray_tracer.h"

#include "raytrace/tracing/march.h"
#include "raytrace/tracing/ocean.h"

namespace asdic::detail {

RayTracer::RayTracer(const Environment& environment, double frequency, Reflection reflection)
    : ocean_(std::make_unique<const Ocean>(environment, frequency, reflection)) {}
RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;
RayTracer& RayTracer::operator=(RayTracer&&) noexcept = default;

const Environment& RayTracer::environment() const noexcept { return ocean_->environment; }

double RayTracer::frequency() const noexcept { return ocean_->frequency; }

double RayTracer::steepest_slope(BoundaryKind kind) const noexcept {
  return (kind == BoundaryKind::surface ? ocean_->surface : ocean_->bottom).steepest;
}

void RayTracer::trace(double source_range, double source_depth, double launch_elevation,
                      const TraceLimits& limits, RayTrajectory& out) const {
  tracing::March(*ocean_, limits, out).run(source_range, source_depth, launch_elevation);
}

double RayTracer::trace_past(std::span<const double> ranges, double source_range,
                             double source_depth, double launch_elevation,
                             const TraceLimits& limits, RangeVisitor& visitor) const {
  thread_local RayTrajectory bounces_only;
  tracing::March march(*ocean_, limits, bounces_only);
  march.tell(ranges, visitor);
  march.run(source_range, source_depth, launch_elevation);
  return bounces_only.source_speed;
}

RayState RayTracer::state_at_range(const RaySegment& segment, double range) const {
  const RayState &y = segment.begin, &end = segment.end;
  const bool along_a_line = y.depth == end.depth && y.zeta == 0.0 && end.zeta == 0.0;
  if (along_a_line) return state_at(segment, arc_at_range(segment, range));
  const tracing::Cell& cell = ocean_->cell(ocean_->row(0.5 * (y.depth + end.depth)),
                                           ocean_->column(0.5 * (y.range + end.range)));
  tracing::Course course;
  RayState from = y;
  course.begin(cell, from, tracing::local(cell, from));
  double last = end.time - from.time, last_range = end.range;
  while (!course.closed()) {  // a series may end before a segment that crossed a row at once
    course.expand(end.time - from.time);
    if (course.reach() >= end.time - from.time) {
      last = end.time - from.time;
      last_range = end.range;
      break;
    }
    last = course.reach();
    const RayState next = course.end(last);
    last_range = next.range;
    if ((range <= next.range) == (next.range >= y.range)) break;
    from = next;
    course.begin(cell, from, tracing::local(cell, from));
  }
  const double h = course.to_range(range, from.range, last_range, last);
  // straight up and down rounding may have it miss the range
  if (!(h < tracing::never)) return state_at(segment, arc_at_range(segment, range));
  RayState there = course.end(h);
  there.range = range;
  return there;
}

}  // namespace asdic::detail
