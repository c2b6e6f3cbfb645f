#include "raytrace/layered/followed_branch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/units.h"
#include "raytrace/layered/path_builder.h"
#include "raytrace/layered/root_search.h"
#include "raytrace/layered/simd_column.h"

namespace asdic::detail {
namespace {

constexpr int most_steps = 8;
constexpr double near_enough = 1e-5;        // miss [m], as in root_search.cpp
constexpr double greatest_bend = 0.3;       // of dr/dσ from the first ray to the last
constexpr double greatest_step = 0.25;      // of the distance to the next singular ray
const double furthest_turn = radians(1.0);  // of the launch angle

/// Speeds at which the fan is singular on either side of a turning speed: those at the edges of
/// layers (cuts inside Munk's law included, which costs a search now and then).
struct SpeedGap {
  double slow = 0.0, fast = std::numeric_limits<double>::infinity();
};

SpeedGap gap_around(const Column& column, double turning_speed) {
  SpeedGap gap;
  const auto meet = [&](double speed) {
    if (speed <= turning_speed)
      gap.slow = std::max(gap.slow, speed);
    else
      gap.fast = std::min(gap.fast, speed);
  };
  for (const Layer& layer : column.layers()) {
    meet(layer.c_top);
    meet(layer.c_bottom);
  }
  return gap;
}

/// A ray traced, and how its range depends on σ or, steep, on −cos θ.
struct Shot {
  double miss = 0.0;   ///< [m]
  double slope = 0.0;  ///< dr/dσ, or dr/d(−k) of steep rays [m]
};

}  // namespace

WaterBetween::WaterBetween(double source, double receiver, const KeptOcean& kept)
    : source_depth(source), receiver_depth(receiver), column(kept.layers, source, receiver) {
  if (kept.series != nullptr) legs.emplace(column, *kept.series, kept.layers);
}

std::optional<Arrival> followed_branch(const Environment& ocean, const WaterBetween& water,
                                       double range, double frequency, const Arrival& known,
                                       const PathLimits& limits) {
  const Column& column = water.column;
  const double turning_speed = 1.0 / known.horizontal_slowness;
  if (!(turning_speed > column.barrier_speed())) return std::nullopt;
  const SpeedGap gap = gap_around(column, turning_speed);
  const double c_ref = gap.slow, ratio = c_ref / gap.fast;
  const double sigma_end = std::sqrt((1.0 - ratio) * (1.0 + ratio));

  const Branch branch{.starts_up = known.launch_elevation > 0.0,
                      .vertices = known.surface_bounces + known.upper_turns + known.bottom_bounces +
                                  known.lower_turns};
  if (branch.vertices == 0 && branch.starts_up == column.source_is_upper()) return std::nullopt;
  const RootPiece piece(branch, column.source_is_upper());
  const RootTask task{.piece = &piece, .range = range}, *const one = &task;
  const SimdTasks tasks(&one, 1);

  const double k0 = known.horizontal_slowness * c_ref;
  const double first = std::sqrt(std::max(0.0, (1.0 - k0) * (1.0 + k0)));
  const bool steep = first > steep_sigma;
  const auto shoot = [&](const SimdRays& rays, const SimdColumn& legs) {
    const Rays reached = rays.slowness * tasks.of(legs.up.per_slowness, legs.middle.per_slowness,
                                                  legs.down.per_slowness);
    const Rays d_range = tasks.of(legs.up.d_range, legs.middle.d_range, legs.down.d_range);
    const Rays slope =
        steep ? Rays(-d_range / c_ref) : Rays(-rays.sigma * d_range * rays.per_c2 / rays.slowness);
    return Shot{.miss = static_cast<double>(reached[0]) - range,
                .slope = static_cast<double>(slope[0])};
  };

  LegSource source{.column = column};
  if (water.legs) {
    source.kept = &*water.legs;
    source.found = water.legs->find(c_ref, first);
  }
  double sigma = first, first_slope = 0.0;
  for (int step = 0; step < most_steps; ++step) {
    const SimdRays rays(c_ref, Rays(sigma));
    // The first ray misses, as a rule, and the second one does not: series of times are not asked
    // for in vain.
    SimdColumn legs = step == 0 && source.kept != nullptr ? source.sums(rays) : source.all(rays);
    const Shot shot = shoot(rays, legs);
    if (step == 0) first_slope = shot.slope;
    if (!(std::abs(shot.slope / first_slope - 1.0) < greatest_bend)) return std::nullopt;
    const bool turned_before = known.upper_turns > 0, turned_below_before = known.lower_turns > 0;
    if ((branch.top_vertices() > 0 && legs.turns_above != turned_before) ||
        (branch.bottom_vertices() > 0 && legs.turns_below != turned_below_before))
      return std::nullopt;
    if (std::abs(shot.miss) < near_enough) {
      if (step == 0 && source.kept != nullptr) legs = source.all(rays);
      const FanInterval interval{.reference_speed = c_ref,
                                 .turns_above = legs.turns_above,
                                 .turns_below = legs.turns_below};
      std::vector<Arrivals> found(1);
      PathBuilder(ocean, column, frequency)
          .build(interval, tasks, {rays, legs}, limits.faintest, found);
      if (found.front().empty()) return std::nullopt;
      Arrival path = std::move(found.front().front());
      if (path.caustics != known.caustics ||
          !(std::abs(path.launch_elevation - known.launch_elevation) < furthest_turn) ||
          !(std::abs(path.launch_elevation) <= limits.max_launch_angle))
        return std::nullopt;
      return path;
    }
    const double by = -shot.miss / shot.slope;
    const double k = std::sqrt((1.0 - sigma) * (1.0 + sigma));
    sigma = steep ? sine_of_cosine(by - k) : sigma + by;
    if (!(std::abs(sigma - first) < greatest_step * std::min(first, sigma_end - first)))
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace asdic::detail
