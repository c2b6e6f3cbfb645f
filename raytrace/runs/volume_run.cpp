#include "raytrace/runs/volume_run.h"

#include <algorithm>
#include <array>
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
#include "raytrace/volume/volume_fan.h"

namespace asdic::detail {
namespace {

constexpr int most_volume_bounces = 64;          // off either boundary
constexpr double faintest_volume_path = 1e-3;    // product of reflections
constexpr std::size_t most_volume_rays = 8000;   // within cells, and by Newton's method
constexpr std::size_t most_field_rays = 240000;  // the same of all receivers of a field together
constexpr std::size_t least_volume_rays = 60;    // and of one of them
constexpr double edge_of_volume_fan = 1e-12;     // elevations there belong to it [rad]

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

/// The run's sources and receivers in three dimensions.
struct VolumePlaces {
  Vec2 place = Vec2::Zero();
  double bearing = 0.0;

  /// Range 0 of a transect is at the map's origin, the transect goes north.
  explicit VolumePlaces(const PropagationCase& run_case) {
    if (run_case.on_area) {
      place = run_case.on_area->place;
      bearing = run_case.on_area->bearing;
    }
    bearing += run_case.off_transect;
  }
  [[nodiscard]] Vec3 source(double depth) const { return {place.x(), place.y(), depth}; }
  [[nodiscard]] Vec3 receiver(const ReceiverPoint& at) const {
    return {place.x() + at.range * std::sin(bearing), place.y() + at.range * std::cos(bearing),
            at.depth};
  }
};

/// What a search may cost, by how many receivers there are, and how near it comes: the phase of a
/// field needs a ten-thousandth of a wavelength.
VolumePrecision volume_precision(const PropagationCase& run_case, double c, std::size_t receivers) {
  VolumePrecision precision{.most_rays = most_volume_rays};
  if (run_case.task != Task::field) return precision;
  const double wavelength = c / run_case.frequency;
  precision.miss = std::clamp(1e-4 * wavelength, 1e-5, 1e-3);
  precision.step = std::clamp(1e-5 * wavelength, 1e-7, 1e-4);
  precision.most_rays = std::clamp(most_field_rays / std::max<std::size_t>(receivers, 1),
                                   least_volume_rays, most_volume_rays);
  return precision;
}

std::unique_ptr<const VolumeOcean> volume_of(const PropagationCase& run_case) {
  if (run_case.on_area) return std::make_unique<const AreaVolume>(run_case.on_area->area);
  return std::make_unique<const TransectVolume>(run_case.environment, Transect{});
}

}  // namespace

PropagationResult run_volume(const PropagationCase& run_case, const Progress& progress) {
  check_volume_case(run_case);
  const VolumePlaces places(run_case);
  const std::unique_ptr<const VolumeOcean> volume = volume_of(run_case);
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
  // One fan for all receivers on a bearing: those ahead, and those behind the source.
  std::array<std::vector<std::size_t>, 2> sides;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const ReceiverPoint& at = receivers[i];
    if (at.depth >= plane.surface.depth_at(at.range) && at.depth <= plane.bottom.depth_at(at.range))
      sides[at.range < 0.0 ? 1 : 0].push_back(i);
  }
  const std::size_t searched = sources * (sides[0].size() + sides[1].size());
  const double fan_share = searched > 8 ? 0.1 : 0.5;  // of the work, roughly
  double begun = 0.0;                                 // share of receivers before the fan in hand
  std::atomic<bool> stopped = false;
  for (std::size_t source = 0; source < sources; ++source)
    for (const std::vector<std::size_t>& side : sides) {
      if (side.empty()) continue;
      const double share = double(side.size()) / double(searched);
      const auto told = [&](double part) {
        return !progress || progress(std::min(1.0, begun + share * part));
      };
      const Vec3 from = places.source(run_case.source_depths[source]);
      const VolumePrecision precision =
          volume_precision(run_case, volume->speed_at(from).c, searched);
      std::vector<Vec3> to;
      for (const std::size_t i : side) to.push_back(places.receiver(receivers[i]));
      const VolumeFan fan(tracer, from, to, limits,
                          [&](double part) { return told(fan_share * part); });
      std::atomic<std::size_t> done = 0;
      in_parallel(side.size(), [&](std::size_t k) {
        if (stopped) return;
        const std::size_t i = source * receivers.size() + side[k];
        const auto looked = [&](double part) {
          const double within = side.size() > 8 ? 0.0 : part;  // as one of many it counts whole
          return told(fan_share +
                      (1.0 - fan_share) * (double(done) + within) / double(side.size()));
        };
        arrivals[i] = volume_eigenrays(fan, to[k], &reports[i], precision, looked);
        ++done;
        std::erase_if(arrivals[i], [&](const Arrival& a) {
          return a.launch_elevation < beams.lowest - edge_of_volume_fan ||
                 a.launch_elevation > beams.highest + edge_of_volume_fan;
        });
        if (beams.pattern)
          for (Arrival& a : arrivals[i]) a.amplitude *= beams.pattern->at(a.launch_elevation);
        if (!looked(0.0)) stopped = true;
      });
      if (stopped) throw Interrupted();
      begun += share;
    }
  if (progress) progress(1.0);

  PropagationResult result;
  std::size_t unfinished = 0, ended = 0;
  for (const VolumeSearchReport& report : reports) {
    if (report.unfinished > 0) ++unfinished;
    if (report.given_up > 0) ++ended;
  }
  char text[320];
  std::snprintf(
      text, sizeof text,
      "rays in three dimensions: %s of up to %d bounces off each boundary that keep at "
      "least 60 dB of their reflections; sound where no ray goes, its shape at a caustic, "
      "and bundles that spread to 70 dB below a sphere's are left out",
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
  if (ended > 0) {
    std::snprintf(text, sizeof text,
                  "rays in three dimensions: at %zu of %zu receivers the search was ended for its "
                  "cost, the finest parts of the launch directions left out; paths of many bounces "
                  "may be missing there",
                  ended, all);
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
