#include "raytrace/runs/rays_run.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "raytrace/parallel/parallel.h"
#include "raytrace/paths/drawn_path.h"
#include "raytrace/runs/checks.h"
#include "raytrace/runs/single_beam.h"

namespace asdic::detail {
namespace {

constexpr int usual_count = 50;
constexpr double faintest_ray = 0.005;

std::vector<double> elevations_of(const BeamSettings& beams) {
  if (!beams.elevations.empty()) return beams.elevations;
  const int count = beams.count > 0 ? beams.count : usual_count;
  std::vector<double> elevations;
  for (int i = 0; i < count; ++i)
    elevations.push_back(count == 1
                             ? beams.lowest
                             : beams.lowest + (beams.highest - beams.lowest) * i / (count - 1));
  return elevations;
}

}  // namespace

void limit_depth(const PropagationCase& run_case, TraceLimits& limits) noexcept {
  if (!(run_case.box_depth > 0.0)) return;
  limits.max_depth = run_case.box_depth;
  limits.min_depth = -run_case.box_depth;
}

TraceLimits box_of(const PropagationCase& run_case) {
  TraceLimits limits;
  double range = run_case.box_range;
  if (!(range > 0.0))
    for (const double r : run_case.receivers.ranges) range = std::max(range, r);
  limits.max_range = range;
  limits.min_range = -range;
  limit_depth(run_case, limits);
  return limits;
}

PropagationResult run_rays(const PropagationCase& run_case, const Progress& progress) {
  check_sources(run_case);
  const RayTracer tracer = tracer_of(run_case);
  TraceLimits limits = box_of(run_case);
  limits.faintest = faintest_ray;
  const std::optional<SingleBeam> single = single_beam(run_case);
  const std::vector<double> elevations =
      single ? std::vector{single->elevation} : elevations_of(run_case.beams);
  const std::size_t sources = run_case.source_depths.size(), rays = elevations.size();
  PropagationResult result;
  result.beams = rays;
  result.rays.assign(sources, std::vector<RayPath>(rays));
  tbb::enumerable_thread_specific<RayTrajectory> trajectories;
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  in_parallel(sources * rays, [&](std::size_t i) {
    if (stopped) return;
    RayTrajectory& ray = trajectories.local();
    tracer.trace(0.0, run_case.source_depths[i / rays], elevations[i % rays], limits, ray);
    result.rays[i / rays][i % rays] = drawn_path(ray);
    const std::size_t n = ++done;
    if (progress && n % 64 == 0 && !progress(double(n) / double(sources * rays))) stopped = true;
  });
  if (stopped) throw Interrupted();
  return result;
}

}  // namespace asdic::detail
