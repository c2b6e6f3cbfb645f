#include "raytrace/runs/volume_run.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/error.h"
#include "core/geometry.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/runs/checks.h"
#include "raytrace/volume/area_volume.h"
#include "raytrace/volume/transect_volume.h"
#include "raytrace/volume/volume_eigenrays.h"

namespace asdic::detail {
namespace {

constexpr int most_volume_bounces = 64;        // off either boundary
constexpr double faintest_volume_path = 1e-3;  // product of reflections
constexpr double edge_of_volume_fan = 1e-12;   // elevations there belong to it [rad]

/// What three dimensions do not do is refused.
void check_volume_case(const PropagationCase& run_case) {
  if (run_case.task != Task::arrivals && run_case.task != Task::field)
    throw InputError({.where = "run.task",
                      .got = "drawn rays in three dimensions",
                      .expected = "\"arrivals\" or \"field\" where run.dimension = 3"});
  if (run_case.field == FieldKind::semi_coherent)
    throw InputError({.where = "run.field",
                      .got = "a semi-coherent field in three dimensions",
                      .expected = "\"coherent\" or \"incoherent\" where run.dimension = 3"});
  if (run_case.task == Task::field && run_case.solver == FieldSolver::waves)
    throw InputError({.where = "run.solver",
                      .got = "\"waves\" in three dimensions",
                      .expected = "\"auto\" or \"beams\": a sum of rays where run.dimension = 3"});
  if (run_case.beams.source == SourceKind::line)
    throw InputError({.where = "run.source.kind",
                      .got = "a line in three dimensions",
                      .expected = "\"point\" where run.dimension = 3"});
  if (run_case.beams.displacement)
    throw InputError({.where = "run.beams.displacement",
                      .got = "true in three dimensions",
                      .expected = "false where run.dimension = 3"});
  check_sources(run_case);
  check_receivers(run_case);
}

std::unique_ptr<const VolumeOcean> volume_of(const PropagationCase& run_case) {
  if (run_case.on_area) return std::make_unique<const AreaVolume>(run_case.on_area->area);
  return std::make_unique<const TransectVolume>(run_case.environment, Transect{});
}

}  // namespace

PropagationResult run_volume(const PropagationCase& run_case, const Progress& progress) {
  check_volume_case(run_case);
  // range 0 of the transect at the map's origin, the transect to the north
  const std::unique_ptr<const VolumeOcean> volume = volume_of(run_case);
  const Vec2 place = run_case.on_area ? run_case.on_area->place : Vec2::Zero();
  const double bearing =
      (run_case.on_area ? run_case.on_area->bearing : 0.0) + run_case.off_transect;
  const VolumeTracer tracer(*volume, run_case.frequency);
  const Environment plane = plane_of(run_case);
  const std::vector<ReceiverPoint> receivers = points_of(run_case.receivers);
  const BeamSettings& beams = run_case.beams;
  const PathLimits limits{.max_surface_bounces = most_volume_bounces,
                          .max_bottom_bounces = most_volume_bounces,
                          .max_launch_angle = std::min(
                              0.5 * pi, std::max(std::abs(beams.lowest), std::abs(beams.highest))),
                          .faintest = faintest_volume_path};
  const double omega = 2.0 * pi * run_case.frequency;
  const bool coherent = run_case.field == FieldKind::coherent;
  const std::size_t sources = run_case.source_depths.size(), all = sources * receivers.size();
  std::vector<Arrivals> arrivals(all);
  std::vector<VolumeSearchReport> reports(all);
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  in_parallel(all, [&](std::size_t i) {
    if (stopped) return;
    const ReceiverPoint& at = receivers[i % receivers.size()];
    const Vec3 from(place.x(), place.y(), run_case.source_depths[i / receivers.size()]),
        to(place.x() + at.range * std::sin(bearing), place.y() + at.range * std::cos(bearing),
           at.depth);
    if (at.depth >= plane.surface.depth_at(at.range) && at.depth <= plane.bottom.depth_at(at.range))
      arrivals[i] = volume_eigenrays(tracer, from, to, limits, &reports[i]);
    std::erase_if(arrivals[i], [&](const Arrival& a) {
      return a.launch_elevation < beams.lowest - edge_of_volume_fan ||
             a.launch_elevation > beams.highest + edge_of_volume_fan;
    });
    if (beams.pattern)
      for (Arrival& a : arrivals[i]) a.amplitude *= beams.pattern->at(a.launch_elevation);
    if (progress && !progress(double(++done) / double(all))) stopped = true;
  });
  if (stopped) throw Interrupted();

  PropagationResult result;
  std::size_t unfinished = 0;
  for (const VolumeSearchReport& report : reports)
    if (report.unfinished > 0) ++unfinished;
  char text[320];
  std::snprintf(text, sizeof text,
                "rays in three dimensions: %s of up to %d bounces off each boundary that keep at "
                "least 60 dB of their reflections; sound where no ray goes, and its shape at a "
                "caustic, are left out",
                run_case.task == Task::field ? "the field is the sum of all paths" : "paths",
                most_volume_bounces);
  result.notes.emplace_back(text);
  if (unfinished > 0) {
    std::snprintf(
        text, sizeof text,
        "rays in three dimensions: at %zu of %zu receivers neighbouring rays part without "
        "end (edges of facets, caustics); a faint path may be missing there",
        unfinished, all);
    result.notes.emplace_back(text);
  }
  if (run_case.task == Task::arrivals) {
    result.arrivals = std::move(arrivals);
    return result;
  }
  for (const Arrivals& here : arrivals) {
    std::complex<double> sum = 0.0;
    for (const Arrival& a : here) {
      const std::complex<double> p = a.amplitude * std::polar(1.0, -omega * a.delay);
      sum += coherent ? p : std::complex<double>(std::norm(p));
    }
    result.field.emplace_back(coherent ? sum : std::sqrt(sum));
  }
  return result;
}

}  // namespace asdic::detail
