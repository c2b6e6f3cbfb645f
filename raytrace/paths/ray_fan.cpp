#include "raytrace/paths/ray_fan.h"

#include <cmath>
#include <optional>

#include "raytrace/layered/layered_fan.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {
namespace {

class FirstPass final : public RangeVisitor {
 public:
  explicit FirstPass(RayAtRange& out) : out_(out) { out_ = {}; }
  void pass(std::size_t, const RayState& y, const RayHistory& history) override {
    if (out_.arrived) return;
    // a zero of q since the segment's begin is counted by the tracer
    out_ = {.arrived = true,
            .depth = y.depth,
            .elevation = -std::atan2(y.zeta, y.xi),
            .time = y.time,
            .q = y.q,
            .p = y.p,
            .surface_bounces = history.surface_bounces,
            .bottom_bounces = history.bottom_bounces,
            .turns = history.upper_turns + history.lower_turns,
            .caustics = history.caustics,
            .reflection = history.reflection};
  }

 private:
  RayAtRange& out_;
};

}  // namespace

struct RayFan::Solvers {
  std::optional<LayeredFan> layered;
  RayTracer marching;
  double source_depth;
};

RayFan::RayFan(const Environment& environment, double frequency, double source_depth)
    : solvers_(new Solvers{.layered = LayeredFan::make(environment, frequency, source_depth),
                           .marching = RayTracer(environment, frequency),
                           .source_depth = source_depth}) {}
RayFan::~RayFan() = default;

void RayFan::trace(std::span<const double> elevations, double range,
                   std::span<RayAtRange> out) const {
  LayeredFan::Workspace work;
  for (std::size_t i = 0; i < elevations.size(); ++i) {
    if (solvers_->layered && solvers_->layered->trace(elevations[i], range, work, out[i])) continue;
    FirstPass first(out[i]);
    solvers_->marching.trace_past(std::span(&range, 1), 0.0, solvers_->source_depth, elevations[i],
                                  {.max_range = 1.001 * range + 1.0, .faintest = 0.0}, first);
  }
}

}  // namespace asdic::detail
