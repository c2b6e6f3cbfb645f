#include "raytrace/paths/boundary_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/units.h"
#include "raytrace/layered/path_builder.h"
#include "raytrace/math/hermite.h"
#include "raytrace/math/monotone_root.h"
#include "raytrace/ocean/tube_amplitude.h"
#include "raytrace/tracing/cell_hits.h"
#include "raytrace/tracing/level_hits.h"

namespace asdic::detail {
namespace {

struct CellPath {
  std::uint32_t cell;
  BoundaryPath path;
};

/// A point of a branch: range and delay as functions of the angle θ, σ = sin θ, with exact slopes.
/// Over σ the range is no cubic straight up and down (r ∝ cos θ), over ξ = cos θ/c_ref none along
/// the horizon.
struct BranchPoint {
  HermiteNode range, delay;  // dτ/dθ = ξ·dr/dθ
  double length = 0.0;       // of the path so far [m]
};

/// Whether a cubic rises, or falls, all the way between two points of it, by the sufficient
/// condition of Fritsch & Carlson: no slope there is against the rise (but for a caustic's, which
/// is rounding), nor above three times that of the chord.
bool is_monotone(const HermiteNode& a, const HermiteNode& b) {
  const double chord = (b.value - a.value) / (b.x - a.x);
  const auto tame = [chord](double slope) {
    return slope / chord >= -1e-3 && slope / chord <= 3.0;
  };
  return tame(a.slope) && tame(b.slope);
}

class BranchFollower {
 public:
  BranchFollower(const Environment& environment, const BranchTable& fan, const GroundLevel& level,
                 const GroundGrid& grid, double max_range, double frequency,
                 std::vector<CellPath>& out)
      : fan_(fan),
        builder_(environment, fan.column(), frequency),
        level_(level),
        grid_(grid),
        spacing_(grid.spacing()),
        max_range_(max_range),
        frequency_(frequency),
        max_delay_(fan.limits().max_delay),
        home_slowness_(fan.limits().home_slowness),
        out_(out) {}

  void follow(const MonotonePiece& s) {
    stop_point();
    const int cycles = cycles_told_by(s.branch.vertices / 2);
    if (cycles == 0) return;
    strength_ = std::sqrt(cycles);
    if (level_.boundary && s.branch.arrives_upward() != (level_.boundary == BoundaryKind::surface))
      return;  // the field that falls on the boundary
    if (s.interval != reached_of_) reached_.clear();
    reached_of_ = s.interval;
    piece_ = &s;
    weights_ = weights(s.branch, fan_.column().source_is_upper());
    turns_ = (s.interval->turns_above ? s.branch.top_vertices() : 0) +
             (s.interval->turns_below ? s.branch.bottom_vertices() : 0);
    floor_ = 0.0;
    const BranchPoint begin = point(std::asin(s.sigma_begin)), end = point(std::asin(s.sigma_end));
    const Hermite cubic(begin.range, end.range);
    if (s.caustic_begin) floor_ = std::max(floor_, floor_at(begin.range.x, end.range.x, cubic));
    if (s.caustic_end) floor_ = std::max(floor_, floor_at(end.range.x, begin.range.x, cubic));
    refine(begin, end, 0);
  }

 private:
  RayParameter ray(double theta) const {
    return {piece_->interval->reference_speed, std::sin(theta)};
  }
  /// dξ/dθ.
  static double slowness_per_angle(const RayParameter& r) { return -r.sigma / r.reference_speed; }

  /// A ray of the interval on its way through the column. Branches of one interval, which differ in
  /// how often they go up and down, end at the same nodes and are halved alike: asked for once.
  Column::All through_column(double theta) {
    for (const Reached& known : reached_)
      if (known.theta == theta) return known.legs;
    return reached_.emplace_back(Reached{theta, fan_.column().all(ray(theta))}).legs;
  }

  BranchPoint point(double theta) {
    const RayParameter r = ray(theta);
    const auto [sums, details] = through_column(theta);
    const double range = weights_.of(sums.up.range, sums.middle.range, sums.down.range);
    const double slope = weights_.of(sums.up.d_range, sums.middle.d_range, sums.down.d_range) *
                         slowness_per_angle(r);
    return {.range = {theta, range, slope},
            .delay = {theta, weights_.of(details.up.time, details.middle.time, details.down.time),
                      slope * r.slowness},
            .length = weights_.of(details.up.length, details.middle.length, details.down.length)};
  }

  double floor_at(double caustic, double other, const Hermite& cubic) const {
    const double step =
        1e-3 * (other - caustic);  // r″ with respect to θ at the caustic, where r′ = 0
    const double per_angle2 = std::abs(cubic.slope(caustic + step) / step);
    const double chain = slowness_per_angle(ray(caustic));
    return airy_floor(per_angle2 / (chain * chain), frequency_);
  }

  void refine(const BranchPoint& a, const BranchPoint& b, int depth) {
    if (!(b.range.x > a.range.x)) return;  // one and the same ray, to rounding
    const double low = std::min(a.range.value, b.range.value),
                 high = std::max(a.range.value, b.range.value);
    if (high < grid_.range(0) || low > max_range_) return;
    const double spacing = grid_.spacing_at(low);
    const Hermite range(a.range, b.range), delay(a.delay, b.delay);
    // Where the next ray meets a knot or a boundary r goes like a square root: its slope at that
    // end tells nothing of a piece that is wider than the end's own surroundings.
    const bool tame = is_monotone(a.range, b.range) && is_monotone(a.delay, b.delay);
    if (tame && grid_.wide() > spacing_ && !holds_cell(low, high)) return;
    const double middle = 0.5 * (a.range.x + b.range.x);
    const bool apart = middle > a.range.x && middle < b.range.x;
    if (depth < 12 && apart && (high - low > 0.5 * spacing || (!tame && holds_cell(low, high)))) {
      const BranchPoint m = point(middle);
      const double error = std::abs(range.value(middle) - m.range.value) +
                           std::abs(delay.value(middle) - m.delay.value) / ray(middle).slowness;
      if (!tame || error > 0.01 * spacing) {
        refine(a, m, depth + 1);
        refine(m, b, depth + 1);
        return;
      }
    }
    if (tame)
      grid_paths(a, b, range, delay);
    else  // too narrow to halve: by chords
      grid_paths(a, b, chord(a.range, b.range), chord(a.delay, b.delay));
  }

  /// Whether neighbouring numbers θ are rays within a hundredth of the spacing. Where they are not,
  /// beside a maximum of c, a path has 10⁻⁵ of the others' amplitude and less.
  [[nodiscard]] bool is_told(double theta, double range_slope) const {
    return std::abs(range_slope) * theta * std::numeric_limits<double>::epsilon() < 0.01 * spacing_;
  }

  static Hermite chord(HermiteNode a, HermiteNode b) {
    a.slope = b.slope = (b.value - a.value) / (b.x - a.x);
    return {a, b};
  }

  /// Whether the centre of a cell lies between two ranges.
  [[nodiscard]] bool holds_cell(double low, double high) const {
    return grid_.range(grid_.count(low)) < high;
  }

  /// Every cell centre between the ranges of two points.
  void grid_paths(const BranchPoint& a, const BranchPoint& b, const Hermite& range,
                  const Hermite& delay) {
    const bool rising = b.range.value > a.range.value;
    const BranchPoint& near = rising ? a : b;
    const BranchPoint& far = rising ? b : a;
    const std::size_t first = grid_.count(near.range.value);
    const double limit = std::min(far.range.value, max_range_);
    const double lo = std::min(near.range.x, far.range.x), hi = std::max(near.range.x, far.range.x);
    double theta = near.range.x;
    for (auto cell = static_cast<std::uint32_t>(first);; ++cell) {
      const double r = grid_.range(cell);
      if (r >= limit) return;
      theta = monotone_root(range, r, lo, hi, rising, theta,
                            1e-6 * spacing_);  // from the neighbour's
      if (!is_told(theta, range.slope(theta))) continue;
      const double share = (r - near.range.value) / (far.range.value - near.range.value);
      // by the mean speed: L/τ is linear where L is not
      const double tau = delay.value(theta);
      if (tau + home_slowness_ * r > max_delay_) continue;
      const double mean_speed =
          std::lerp(near.length / near.delay.value, far.length / far.delay.value, share);
      out_.push_back({cell, path(theta, r, tau, range.slope(theta), tau * mean_speed)});
    }
  }

  BoundaryPath path(double theta, double range, double delay, double slope, double length) const {
    const RayParameter r = ray(theta);
    const Column& column = fan_.column();
    const Branch& branch = piece_->branch;
    double per_slowness = slope / slowness_per_angle(r);
    const int caustics = caustics_passed(turns_, per_slowness);
    per_slowness = std::max(std::abs(per_slowness), floor_);
    const int tops = piece_->interval->turns_above ? 0 : branch.top_vertices();
    const int bottoms = piece_->interval->turns_below ? 0 : branch.bottom_vertices();
    const double spreading = strength_ * builder_.spreading(r, range, per_slowness);
    const double absorbed = amplitude_from_db(-builder_.absorption_db_per_metre() * length);
    return {
        .delay = delay,
        .amplitude =
            path_amplitude(spreading, absorbed, builder_.all_reflected(r, tops, bottoms), caustics),
        .launch_elevation =
            (branch.starts_up ? 1.0 : -1.0) *
            std::atan2(builder_.sine_at_source(r), r.slowness * column.source_speed()),
        .grazing = std::atan2(builder_.sine_at_receiver(r), r.slowness * column.receiver_speed()),
        .horizontal_slowness = r.slowness,
        .slowness_slope = std::copysign(1.0 / per_slowness, slope / slowness_per_angle(r)),
        .downward = branch.arrives_upward() ? -1.0 : 1.0,
        .length = length,
        .surface_bounces = static_cast<std::uint16_t>(tops),
        .bottom_bounces = static_cast<std::uint16_t>(bottoms)};
  }

  const BranchTable& fan_;
  PathBuilder builder_;
  GroundLevel level_;
  GroundGrid grid_;
  double spacing_, max_range_, frequency_, max_delay_, home_slowness_;
  std::vector<CellPath>& out_;
  struct Reached {
    double theta;
    Column::All legs;
  };
  std::vector<Reached> reached_;  // rays of one interval
  const FanInterval* reached_of_ = nullptr;
  const MonotonePiece* piece_ = nullptr;
  BranchWeights weights_;
  int turns_ = 0;
  double floor_ = 0.0;
  double strength_ = 1.0;  // of the cycles that the branch stands for
};

/// Of a layered ocean: along the branches of its fan.
std::vector<CellPath> follow_branches(const EigenraySolver& solver, double source_depth,
                                      const GroundLevel& level, const GroundGrid& grid,
                                      double max_range, double frequency, const PathLimits& limits,
                                      const StopPoint& stop) {
  const Environment& ocean = solver.environment();
  const double depth = !level.boundary                            ? level.depth
                       : *level.boundary == BoundaryKind::surface ? ocean.surface.depth
                                                                  : ocean.bottom.depth;
  const auto kept = solver.table(source_depth, depth, limits);
  const BranchTable& fan = *kept;
  std::vector<CellPath> found;
  BranchFollower follower(ocean, fan, level, grid, max_range, frequency, found);
  fan.for_each_piece(0.0, max_range, [&](const MonotonePiece& piece) {
    stop();
    follower.follow(piece);
  });
  return found;
}

FanLimits fan_limits(const PathLimits& limits) {
  return {.lowest = -limits.max_launch_angle,
          .highest = limits.max_launch_angle,
          .max_surface_bounces = limits.max_surface_bounces,
          .max_bottom_bounces = limits.max_bottom_bounces,
          .faintest = limits.faintest};
}

/// Hits of marched rays as paths to cells, but for those that come home too late.
std::vector<CellPath> paths_of(const std::vector<CellHit>& hits, const GroundGrid& grid,
                               const PathLimits& limits) {
  std::vector<CellPath> found;
  for (const CellHit& hit : hits) {
    const double range = grid.range(hit.cell);
    if (hit.delay + limits.home_slowness * range > limits.max_delay) continue;
    found.push_back({hit.cell,
                     {.delay = hit.delay,
                      .amplitude = hit.amplitude,
                      .launch_elevation = hit.launch_elevation,
                      .grazing = hit.grazing,
                      .horizontal_slowness = hit.slowness,
                      .slowness_slope = 0.0,
                      .downward = hit.down,
                      .length = hit.length,
                      .surface_bounces = static_cast<std::uint16_t>(hit.surface_bounces),
                      .bottom_bounces = static_cast<std::uint16_t>(hit.bottom_bounces)}});
  }
  return found;
}

/// Of any other: between neighbours of a fan of marched rays.
std::vector<CellPath> march_fan(const EigenraySolver& solver, double source_depth,
                                const GroundLevel& level, const GroundGrid& grid, double max_range,
                                double frequency, const PathLimits& limits, const StopPoint& stop) {
  stop();
  SearchWatch watch{.progress = [&](double /*share*/) {
    stop();
    return true;
  }};
  return paths_of(hits_on_cells(*solver.tracer(frequency), source_depth, level, grid, max_range,
                                frequency, fan_limits(limits), &watch),
                  grid, limits);
}

bool is_finite(const BoundaryPath& p) {
  return std::isfinite(p.delay) && std::isfinite(p.amplitude.real()) &&
         std::isfinite(p.amplitude.imag()) && std::isfinite(p.launch_elevation) &&
         std::isfinite(p.grazing) && std::isfinite(p.horizontal_slowness) &&
         std::isfinite(p.slowness_slope) && std::isfinite(p.length);
}

/// The gate that every path goes through: what uses paths makes indices and sizes of their delays.
void check_finite(std::span<const CellPath> found, double source_depth) {
  const auto bad = std::count_if(found.begin(), found.end(),
                                 [](const CellPath& p) { return !is_finite(p.path); });
  if (bad > 0)
    throw std::runtime_error(
        "rays from " + std::to_string(source_depth) + " m: " + std::to_string(bad) + " of " +
        std::to_string(found.size()) +
        " paths to a boundary are no numbers; this is a fault of asdic, please "
        "report it with the scenario");
}

/// By counting, stable: the order within a cell is the order in which they were found. \param cells
/// how many
void put_into_cells(const std::vector<CellPath>& found, std::size_t cells,
                    std::vector<std::uint32_t>& first, std::vector<BoundaryPath>& paths) {
  first.assign(cells + 1, 0);
  for (const CellPath& p : found) ++first[p.cell + 1];
  for (std::size_t i = 0; i < cells; ++i) first[i + 1] += first[i];
  paths.resize(found.size());
  std::vector<std::uint32_t> next(first.begin(), first.end());
  for (const CellPath& p : found) paths[next[p.cell]++] = p.path;
}

}  // namespace

int cycles_told_by(int cycle) noexcept {
  int stride = 1;  // all_cycles is a multiple of 9: blocks begin where those before end
  while (cycle >= all_cycles * stride) stride *= 3;
  return cycle % stride == stride / 2 ? stride : 0;
}

int followed_cycles(int most) noexcept {
  int followed = 0;
  for (int cycle = 0; cycle <= most; ++cycle) followed += cycles_told_by(cycle) > 0 ? 1 : 0;
  return followed;
}

BoundaryPaths boundary_paths(const EigenraySolver& solver, double source_depth,
                             const GroundLevel& level, const GroundGrid& grid, double max_range,
                             double frequency, const PathLimits& limits, const StopPoint& stop) {
  const GroundGrid own = solver.layered() ? grid : grid.without_fine();
  const std::vector<CellPath> found = (solver.layered() ? follow_branches : march_fan)(
      solver, source_depth, level, own, max_range, frequency, limits, stop);
  check_finite(found, source_depth);
  BoundaryPaths ground;
  ground.grid_ = own;
  put_into_cells(found, own.count(max_range), ground.first_, ground.paths_);
  return ground;
}

std::vector<BoundaryPaths> mean_paths(const EigenraySolver& solver, double source_depth,
                                      std::span<const GroundLevel> levels, const GroundGrid& grid,
                                      double max_range, double frequency, const PathLimits& limits,
                                      int rays) {
  std::vector<BoundaryPaths> all;
  for (const std::vector<CellHit>& hits :
       hits_on_levels(*solver.tracer(frequency), source_depth, levels, grid, max_range, frequency,
                      fan_limits(limits), rays)) {
    const std::vector<CellPath> found = paths_of(hits, grid, limits);
    check_finite(found, source_depth);
    BoundaryPaths ground;
    ground.grid_ = grid;
    put_into_cells(found, grid.count(max_range), ground.first_, ground.paths_);
    all.push_back(std::move(ground));
  }
  return all;
}

}  // namespace asdic::detail
