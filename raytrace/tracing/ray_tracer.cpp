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

}  // namespace asdic
