#include "raytrace/runs/arrivals_run.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "core/units.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/paths/drawn_path.h"
#include "raytrace/paths/energy_bound.h"
#include "raytrace/runs/checks.h"
#include "raytrace/runs/rays_run.h"
#include "raytrace/runs/single_beam.h"
#include "raytrace/tracing/marching_eigenrays.h"

namespace asdic::detail {
namespace {

/// Off either boundary. A waveguide without loss has no end of paths; these are very many, and what
/// is left out is told.
constexpr int most_bounces = 2048;

/// Launch elevations at the edge of the fan belong to it.
constexpr double edge_of_fan = 1e-12;

/// The layered solver knows no box: it serves where all of the water is within it.
bool within_box(const PropagationCase& run_case) {
  const Environment& ocean = run_case.environment;
  return !(run_case.box_depth > 0.0) ||
         (run_case.box_depth >= ocean.bottom.depth && -run_case.box_depth <= ocean.surface.depth);
}

bool forward_only(const BeamSettings& beams) {
  return std::max(std::abs(beams.lowest), std::abs(beams.highest)) <= 0.5 * pi + edge_of_fan;
}

/// How much of the intensity at a receiver paths with more than most_bounces would add at most, as
/// a share of what was found: paths spread as the inverse of their length, which grows with their
/// bounces, so that all after the n-th have no more than n times the intensity of the n-th.
double left_out(const Arrivals& arrivals) {
  double all = 0.0, last = 0.0;
  for (const Arrival& a : arrivals) {
    const double intensity = std::norm(a.amplitude);
    all += intensity;
    if (std::max(a.surface_bounces, a.bottom_bounces) == most_bounces) last += intensity;
  }
  return last > 0.0 ? most_bounces * last / all : 0.0;
}

class ArrivalSearch {
 public:
  ArrivalSearch(const PropagationCase& run_case, const PathSelection& selection)
      : case_(run_case), selection_(selection), receivers_(points_of(run_case.receivers)) {
    // Marched rays need no solver, nor water everywhere: a bottom may come up to the surface.
    if (is_layered(run_case.environment)) solver_.emplace(run_case.environment);
  }

  /// Made when first asked for: layered runs without drawn rays need none.
  [[nodiscard]] const RayTracer& tracer() const {
    if (!tracer_) tracer_.emplace(tracer_of(case_));
    return *tracer_;
  }

  /// [receivers] arrivals of one source, finished. \param notes  what the user should know
  /// \param progress  told the share of this source
  std::vector<Arrivals> from(double source_depth, const Progress& progress,
                             std::vector<std::string>& notes) const {
    const BeamSettings& beams = case_.beams;
    std::vector<Arrivals> found;
    if (solver_ && within_box(case_) && forward_only(beams) && !beams.displacement) {
      const PathLimits limits{
          .max_surface_bounces = most_bounces,
          .max_bottom_bounces = most_bounces,
          .max_launch_angle = std::max(std::abs(beams.lowest), std::abs(beams.highest)),
          .max_vertices = 2 * most_bounces,
          .faintest = selection_.faintest_reflection};
      found = solver_->find(source_depth, receivers_, case_.frequency, limits);
    } else {
      const TraceLimits box = box_of(case_);
      const FanLimits limits{.lowest = beams.lowest,
                             .highest = beams.highest,
                             .max_surface_bounces = most_bounces,
                             .max_bottom_bounces = most_bounces,
                             .max_turns = 2 * most_bounces,
                             .faintest = selection_.faintest_reflection,
                             .min_depth = box.min_depth,
                             .max_depth = box.max_depth,
                             .min_range = box.min_range,
                             .max_range = box.max_range};
      SearchWatch watch{.progress = progress};
      found = marching_eigenrays(tracer(), 0.0, source_depth, receivers_, limits, &watch);
      if (watch.stopped) throw Interrupted();
      if (watch.unfinished > 0)
        notes.push_back("source at " + std::to_string(source_depth) +
                        " m: rays part without end in " + std::to_string(watch.unfinished) +
                        " of " + std::to_string(watch.intervals) +
                        " parts of the fan; faint paths are missing there");
    }
    tell_of_bounces(source_depth, found, notes);
    tell_of_caustics(source_depth, found, notes);
    for (std::size_t i = 0; i < found.size(); ++i) finish(found[i], receivers_[i].range);
    tell_of(source_depth, notes);
    return found;
  }

 private:
  /// Where paths had to be given up at most_bounces.
  static void tell_of_bounces(double depth, const std::vector<Arrivals>& found,
                              std::vector<std::string>& notes) {
    double most = 0.0;
    for (const Arrivals& arrivals : found) most = std::max(most, left_out(arrivals));
    if (most == 0.0) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "source at %g m: paths hardly lose anything in bouncing and have no end; those "
                  "of more than %d bounces off a boundary are left out, at most %.2g dB of the "
                  "incoherent level",
                  depth, most_bounces, db_from_power(1.0 + most));
    notes.emplace_back(text);
  }

  /// Notes the number of receivers at which rays are louder than energy allows.
  void tell_of_caustics(double depth, const std::vector<Arrivals>& found,
                        std::vector<std::string>& notes) const {
    std::size_t loud = 0;
    double most = 1.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double over = excess(found[i], case_.environment,
                                 {.source_depth = depth,
                                  .receiver_depth = receivers_[i].depth,
                                  .range = receivers_[i].range,
                                  .frequency = case_.frequency,
                                  .layered = solver_.has_value()});
      if (over <= 1.0) continue;
      ++loud;
      most = std::max(most, over);
    }
    if (loud == 0) return;
    char text[240];
    std::snprintf(text, sizeof text,
                  "source at %g m: at %zu of %zu receivers rays are up to %.1f dB louder than "
                  "energy allows, because a ray alone has no bound at a caustic",
                  depth, loud, found.size(), db_from_power(most));
    notes.emplace_back(text);
  }

  /// What is special about a source's place.
  void tell_of(double depth, std::vector<std::string>& notes) const {
    if (on_vacuum(case_.environment, depth))
      notes.push_back("the source at " + std::to_string(depth) +
                      " m is on a boundary with a vacuum, which reflects all it sends with the "
                      "opposite sign: paths come in pairs whose sum is nothing");
    const LevelRays level = level_paths(case_.environment, case_.frequency, 0.0, depth);
    const bool received = std::any_of(receivers_.begin(), receivers_.end(), [&](const auto& at) {
      return std::abs(at.depth - depth) <= level.height;
    });
    if (level.angle > 0.0 && received)
      notes.push_back("the source at " + std::to_string(depth) +
                      " m is on a kink where the sound speed is least: rays within " +
                      std::to_string(degrees(level.angle)) +
                      " deg of the horizontal stay within a quarter of a wavelength, " +
                      std::to_string(level.height) +
                      " m, of that depth, and at receivers there the level one stands for all");
  }

  /// Leaves out what the source does not shine at and what is too weak, and gives the source's kind
  /// and pattern to the rest.
  void finish(Arrivals& arrivals, double range) const {
    const BeamSettings& beams = case_.beams;
    std::erase_if(arrivals, [&](const Arrival& a) {
      return a.launch_elevation < beams.lowest - edge_of_fan ||
             a.launch_elevation > beams.highest + edge_of_fan;
    });
    double strongest = 0.0;
    for (Arrival& a : arrivals) {
      double factor = beams.pattern ? beams.pattern->at(a.launch_elevation) : 1.0;
      if (beams.source == SourceKind::line) {
        // 4√π·√(c/(c₀|q|)) instead of √(c cos θ₀/(c₀ r |q|)): BELLHOP's convention
        const double line = 4.0 * std::sqrt(pi * std::max(std::abs(range), 0.1) /
                                            std::abs(std::cos(a.launch_elevation)));
        a.spreading *= line;
        factor *= line;
      }
      a.amplitude *= factor;
      strongest = std::max(strongest, std::abs(a.amplitude));
    }
    const double weakest = strongest * amplitude_from_db(-selection_.weakest_db);
    std::erase_if(arrivals, [&](const Arrival& a) { return !(std::abs(a.amplitude) >= weakest); });
  }

  const PropagationCase& case_;
  PathSelection selection_;
  std::optional<EigenraySolver> solver_;  ///< of a layered ocean
  mutable std::optional<RayTracer> tracer_;
  std::vector<ReceiverPoint> receivers_;
};

/// The eigenrays of one source, traced once more to be drawn.
std::vector<RayPath> drawn(const PropagationCase& run_case, const RayTracer& tracer,
                           double source_depth, const std::vector<Arrivals>& arrivals) {
  std::vector<const Arrival*> all;
  for (const Arrivals& here : arrivals)
    for (const Arrival& a : here) all.push_back(&a);
  std::vector<RayPath> paths(all.size());
  TraceLimits limits = box_of(run_case);
  for (const double range : run_case.receivers.ranges)  // with a little room for rounding
    limits.max_range = std::max(limits.max_range, range + 1.0);
  tbb::enumerable_thread_specific<RayTrajectory> trajectories;
  in_parallel(all.size(), [&](std::size_t i) {
    RayTrajectory& ray = trajectories.local();
    TraceLimits this_one = limits;  // up to the bounce after the last
    this_one.max_surface_bounces = all[i]->surface_bounces + 1;
    this_one.max_bottom_bounces = all[i]->bottom_bounces + 1;
    tracer.trace(0.0, source_depth, all[i]->launch_elevation, this_one, ray);
    paths[i] = drawn_path(ray, all[i]->path_length);
  });
  return paths;
}

PropagationResult search(const PropagationCase& run_case, const Progress& progress,
                         const PathSelection& selection, bool with_rays, bool with_arrivals) {
  if (const auto beam = single_beam(run_case)) {
    const PropagationCase narrow = narrowed_to(*beam, run_case);
    PropagationResult result = search(narrow, progress, selection, with_rays, with_arrivals);
    result.notes.push_back(
        "one beam is wanted: the paths told are those it stands for, launched "
        "within half a spacing of it, " +
        std::to_string(degrees(narrow.beams.lowest)) + " to " +
        std::to_string(degrees(narrow.beams.highest)) + " deg (positive up)");
    return result;
  }
  if (run_case.beams.source == SourceKind::line &&
      run_case.environment.spreading != Spreading::cylindrical) {
    PropagationCase line = run_case;  // spreads nowhere across: finish() takes the cylinder's off
    line.environment.spreading = Spreading::cylindrical;
    return search(line, progress, selection, with_rays, with_arrivals);
  }
  check_sources(run_case);
  check_receivers(run_case);
  const ArrivalSearch paths(run_case, selection);
  PropagationResult result;
  const std::size_t sources = run_case.source_depths.size();
  for (std::size_t i = 0; i < sources; ++i) {
    const double depth = run_case.source_depths[i];
    const auto part = [&](double share) {
      return !progress || progress((double(i) + share) / double(sources));
    };
    std::vector<Arrivals> found = paths.from(depth, part, result.notes);
    if (with_rays) result.rays.push_back(drawn(run_case, paths.tracer(), depth, found));
    if (with_arrivals)
      result.arrivals.insert(result.arrivals.end(), std::make_move_iterator(found.begin()),
                             std::make_move_iterator(found.end()));
    if (progress && !progress(double(i + 1) / double(sources))) throw Interrupted();
  }
  return result;
}

}  // namespace

std::vector<ReceiverPoint> points_of(const ReceiverGrid& grid) {
  std::vector<ReceiverPoint> points;
  points.reserve(grid.size());
  for (std::size_t row = 0; row < grid.rows(); ++row)
    for (std::size_t i = 0; i < grid.ranges.size(); ++i)
      points.push_back({grid.ranges[i], grid.depths[grid.irregular ? i : row]});
  return points;
}

PropagationResult run_arrivals(const PropagationCase& run_case, const Progress& progress,
                               const PathSelection& selection) {
  return search(run_case, progress, selection, false, true);
}

PropagationResult run_eigenrays(const PropagationCase& run_case, const Progress& progress,
                                const PathSelection& selection) {
  return search(run_case, progress, selection, true, run_case.task == Task::eigenrays_and_arrivals);
}

}  // namespace asdic::detail
