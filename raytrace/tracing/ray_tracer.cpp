#include "raytrace/tracing/ray_tracer.h"

#include "raytrace/tracing/march.h"
#include "raytrace/tracing/ocean.h"

namespace asdic {

RayTracer::RayTracer(const Environment& environment, double frequency, Reflection reflection)
    : ocean_(std::make_unique<const Ocean>(environment, frequency, reflection)) {}
RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;
RayTracer& RayTracer::operator=(RayTracer&&) noexcept = default;

const Environment& RayTracer::environment() const noexcept { return ocean_->environment; }

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
  const tracing::Cell cell = ocean_->cell(ocean_->row(0.5 * (y.depth + end.depth)),
                                          ocean_->column(0.5 * (y.range + end.range)));
  tracing::Course course;
  course.begin(cell, y, tracing::local(cell, y));
  if (!course.closed()) course.expand(end.time - y.time);
  const double h = course.to_range(range, y.range, end.range, end.time - y.time);
  // straight up and down rounding may have it miss the range
  if (!(h < tracing::never)) return state_at(segment, arc_at_range(segment, range));
  RayState there = course.end(h);
  there.range = range;
  return there;
}

}  // namespace asdic
