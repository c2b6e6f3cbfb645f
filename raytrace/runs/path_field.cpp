#include "raytrace/runs/path_field.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "raytrace/beams/boundary_rows.h"
#include "raytrace/beams/fan.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/runs/image_field.h"

namespace asdic::detail {
namespace {

constexpr double edge_of_fan_here = 1e-12;   // elevations there belong to it [rad]
constexpr double faintest = 1e-4;            // of reflections, as beams are followed
constexpr int most_bounces_of_paths = 2048;  // off either boundary
constexpr double most_paths = 1e6;           // beyond this beams are cheaper
constexpr std::size_t counted = 5;           // ranges where paths are counted to know

class PathSum {
 public:
  PathSum(const PropagationCase& run_case, double source_depth)
      : case_(run_case),
        source_depth_(source_depth),
        source_speed_(run_case.environment.water.at(source_depth).c),
        coherent_(run_case.field == FieldKind::coherent),
        solver_(run_case.environment),
        walls_(run_case.environment, run_case.frequency, run_case.receivers, coherent_) {
    const BeamSettings& beams = run_case.beams;
    limits_ = {.max_surface_bounces = most_bounces_of_paths,
               .max_bottom_bounces = most_bounces_of_paths,
               .max_launch_angle = std::max(std::abs(beams.lowest), std::abs(beams.highest)),
               .max_vertices = 2 * most_bounces_of_paths,
               .faintest = faintest};
    const auto& ranges = run_case.receivers.ranges;
    const auto end = run_case.box_range > 0.0
                         ? std::upper_bound(ranges.begin(), ranges.end(), run_case.box_range)
                         : ranges.end();
    ranges_.assign(ranges.begin(), end);
  }

  /// About how many paths there are, by those to some receivers of the middle row.
  [[nodiscard]] double count() const {
    if (ranges_.empty()) return 0.0;
    std::vector<double> some;
    for (std::size_t i = 0; i < counted; ++i)
      some.push_back(ranges_[i * (ranges_.size() - 1) / (counted - 1)]);
    const ReceiverGrid& grid = case_.receivers;
    double paths = 0.0;
    for (const Arrivals& here : to(grid.depths[grid.depths.size() / 2], some))
      paths += static_cast<double>(here.size());
    return paths / static_cast<double>(counted) * static_cast<double>(grid.size());
  }

  /// The sums at the receivers of a row. \param sums  [ranges]
  void add_row(std::size_t row, std::span<RaySum> sums) const {
    const double depth = case_.receivers.depths[row];
    const std::vector<Arrivals> found = to(depth, ranges_);
    for (std::size_t j = 0; j < found.size(); ++j)
      if (ranges_[j] != 0.0 && !silent(row, j)) sums[j] = sum(found[j], ranges_[j]);
  }

 private:
  [[nodiscard]] std::vector<Arrivals> to(double depth, std::span<const double> ranges) const {
    const std::optional<double> there = depth_in_water(case_.environment, depth);
    if (!there) return {};
    return solver_.find(source_depth_, *there, ranges, case_.frequency, limits_);
  }
  /// Whether what comes in and what is reflected leave nothing there.
  [[nodiscard]] bool silent(std::size_t row, std::size_t column) const noexcept {
    const auto here = static_cast<std::int32_t>(row);
    return std::any_of(std::begin(both), std::end(both), [&](BoundaryKind kind) {
      return walls_.row(kind, column) == here && walls_.silent(kind, column);
    });
  }
  [[nodiscard]] RaySum sum(const Arrivals& arrivals, double range) const {
    const BeamSettings& beams = case_.beams;
    const double omega = 2.0 * pi * case_.frequency;
    RaySum all;
    for (const Arrival& a : arrivals) {
      if (a.launch_elevation < beams.lowest - edge_of_fan_here ||
          a.launch_elevation > beams.highest + edge_of_fan_here)
        continue;
      double factor = launch_amplitude(case_, source_depth_, source_speed_, a.launch_elevation);
      if (beams.source == SourceKind::line)  // spreads nowhere across
        factor *= 4.0 * std::sqrt(pi * range / std::abs(std::cos(a.launch_elevation)));
      const std::complex<double> p = factor * a.amplitude * std::polar(1.0, -omega * a.delay);
      all.value += coherent_ ? p : std::complex<double>(std::norm(p));
      ++all.paths;
      // Steeper paths lose more: after a last decade of faintness all others bring a ninth of it.
      if (std::norm(a.reflection) < 100.0 * faintest * faintest)
        all.error += coherent_ ? std::abs(p) / 9.0 : std::norm(p) / 99.0;
    }
    return all;
  }

  static constexpr BoundaryKind both[2] = {BoundaryKind::surface, BoundaryKind::bottom};
  const PropagationCase& case_;
  double source_depth_, source_speed_;
  bool coherent_;
  EigenraySolver solver_;
  BoundaryRows walls_;
  PathLimits limits_;
  std::vector<double> ranges_;  // within the box
};

std::string note_of(int paths, double error_db) {
  char text[200];
  std::snprintf(text, sizeof text,
                "stratified water between flat boundaries: the field is the sum of all paths, up "
                "to %d at a receiver; fainter ones are about %.1g dB at 95 %% of the receivers",
                paths, error_db);
  return text;
}

}  // namespace

std::optional<ConvergedField> path_field(const PropagationCase& run_case, double source_depth,
                                         const Progress& progress) {
  const Environment& ocean = run_case.environment;
  const ReceiverGrid& grid = run_case.receivers;
  if (!narrows_to_paths(run_case) || !is_layered(ocean) || grid.irregular) return std::nullopt;
  if (level_rays(ocean, run_case.frequency, 0.0, source_depth).angle > 0.0) return std::nullopt;
  const PathSum paths(run_case, source_depth);
  if (paths.count() > most_paths) return std::nullopt;

  const std::size_t columns = grid.ranges.size(), rows = grid.rows();
  std::vector<RaySum> sums(grid.size());
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  in_parallel(rows, [&](std::size_t i) {
    if (!stopped) paths.add_row(i, std::span(sums).subspan(i * columns, columns));
    if (progress && !progress(double(++done) / double(rows))) stopped = true;
  });
  if (stopped) throw Interrupted();

  ConvergedField result = field_of_sums(sums, run_case.field == FieldKind::coherent);
  int most = 0;
  for (const RaySum& s : sums) most = std::max(most, s.paths);
  result.note = note_of(most, result.error_db);
  return result;
}

}  // namespace asdic::detail
