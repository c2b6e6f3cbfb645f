#include "raytrace/eigenrays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

#include <tbb/parallel_for.h>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/layered/column_fit.h"
#include "raytrace/layered/hermite.h"
#include "raytrace/layered/path_builder.h"
#include "raytrace/tracing/marching_eigenrays.h"

namespace asdic {
namespace {

/// Of a source and a receiver at one depth; the sums take them apart, no answer changes by more
/// than rounding [m].
constexpr double depth_offset = 1e-6;

/// A receiver (almost) straight above or below is met by (almost) vertical rays, whose ξ is
/// proportional to the range; they are found at this range and then put upright. The delay of a
/// path of length h is longer by range²/(2hc), 3 ns at a metre [m].
constexpr double least_range = 0.1;

void raise(Arrival& path, double share, const Column& column) {
  path.horizontal_slowness *= share;
  path.launch_elevation = std::copysign(std::acos(path.horizontal_slowness * column.source_speed()),
                                        path.launch_elevation);
  path.arrival_elevation = std::copysign(
      std::acos(path.horizontal_slowness * column.receiver_speed()), path.arrival_elevation);
  for (Bounce& bounce : path.bounces) {
    const double c =
        bounce.boundary == BoundaryKind::surface ? column.surface_speed() : column.bottom_speed();
    bounce.grazing = std::acos(path.horizontal_slowness * c);
    bounce.range *= share;
  }
}

/// Distance below which two roots of one branch are one [m of range per slope].
constexpr double same_root = 1e-9;

/// The root of r(σ) = range inside a stretch that has it between its ends: from the cubic's guess
/// by Newton, kept inside a shrinking bracket. \param evaluate  σ to exact r and dr/dσ
template <class Evaluate>
double refine(const Evaluate& evaluate, const MonotoneStretch& s, double range) {
  double low = s.sigma_begin, high = s.sigma_end;
  const bool rising = s.range_end > s.range_begin;
  double x =
      low +
      (high - low) * std::clamp((range - s.range_begin) / (s.range_end - s.range_begin), 0.0, 1.0);
  const Hermite cubic({s.sigma_begin, s.range_begin, s.slope_begin},
                      {s.sigma_end, s.range_end, s.slope_end});
  for (int i = 0; i < 4; ++i) {  // the cubic costs little: start from its root
    const double slope = cubic.slope(x), off = cubic.value(x) - range;
    const double next = slope != 0.0 ? x - off / slope : x;
    if (!(next > low && next < high)) break;
    x = next;
    if (std::abs(off) < 0.1) break;
  }
  for (int i = 0; i < 100; ++i) {
    const BranchTable::RangeSlope here = evaluate(x);
    const double r = here.range, slope = here.slope;
    const double miss = r - range;
    ((miss < 0.0) == rising ? low : high) = x;
    if (std::abs(miss) < 1e-5) break;
    double next = slope != 0.0 ? x - miss / slope : low;
    if (!(next > low && next < high)) {
      next = 0.5 * (low + high);
    } else {
      // What the step leaves is ½r″δ², seen on the cubic; it need not be looked at when it is a
      // tenth of a millimetre and changes the slope by no more than 1e-8 (path_builder.cpp sees to
      // it). Next to the vertical, where r goes like √(1 − σ), no cubic tells.
      const double bend = std::abs(cubic.bend(next)), left = 2.0 * bend * (next - x) * (next - x);
      if (left < 1e-4 && left * bend < 1e-8 * slope * slope &&
          std::abs(next - x) < 3e-4 * (1.0 - x))
        return next;
    }
    if (next == x || high - low < 1e-16 * high) break;
    x = next;
  }
  return x;
}

/// Roots on the stretches of one fan: where there are many between two nodes, from series instead
/// of walks through the column.
class RootSource {
 public:
  RootSource(const BranchTable& fan, const PathBuilder& builder) : fan_(fan), builder_(builder) {}

  /// \param count  of roots expected on the stretch
  Arrival at(const MonotoneStretch& s, double range, std::size_t count) {
    ColumnFits* fits = fits_of(s, count);
    if (fits == nullptr) {
      const auto walk = [&](double sigma) { return fan_.evaluate(*s.interval, s.branch, sigma); };
      return builder_.build(*s.interval, s.branch, refine(walk, s, range), range);
    }
    const BranchWeights w = weights(s.branch, fan_.column().source_is_upper());
    const double c_ref = s.interval->reference_speed;
    const auto series = [&](double sigma) {
      const RayParameter ray(c_ref, sigma);
      const ColumnSums sums = fits->sums(ray);
      return BranchTable::RangeSlope{
          w.of(sums.up.range, sums.middle.range, sums.down.range),
          w.of(sums.up.d_range, sums.middle.d_range, sums.down.d_range) * ray.slowness_per_sigma()};
    };
    const RayParameter ray(c_ref, refine(series, s, range));
    return builder_.build(*s.interval, s.branch, ray, fits->all(ray), range);
  }

 private:
  static constexpr std::size_t worth_a_fit = 5;  // a fit takes twelve walks, a root two to three

  ColumnFits* fits_of(const MonotoneStretch& s, std::size_t count) {
    if (interval_ != s.interval) {  // visited one after the other
      interval_ = s.interval;
      fits_.assign(s.interval->sigma.size(), std::nullopt);
    }
    std::optional<ColumnFits>& fits = fits_[s.cell];
    if (!fits) {
      if (count < worth_a_fit) return nullptr;
      fits.emplace(fan_.column(), s.interval->reference_speed, s.interval->sigma[s.cell],
                   s.interval->sigma[s.cell + 1]);
    }
    return &*fits;
  }

  const BranchTable& fan_;
  const PathBuilder& builder_;
  const FanInterval* interval_ = nullptr;
  std::vector<std::optional<ColumnFits>> fits_;
};

/// The ray along a depth where the speed has no gradient, which r(σ) cannot tell: it stays there,
/// and its beam obeys d²q/dr² = −(c″/c)·q.
Arrival horizontal_ray(const Environment& ocean, double depth, double range, double frequency) {
  const SoundSpeed water = ocean.water.at(depth);
  const double k =
      std::sqrt(std::abs(water.d2c_dz2) /
                water.c);  // q = sin(kr)/k about a minimum of c, sinh(kr)/k about a maximum
  Arrival path;
  path.q = k * range < 1e-6
               ? range
               : (water.d2c_dz2 > 0.0 ? std::sin(k * range) : std::sinh(k * range)) / k;
  path.caustics = water.d2c_dz2 > 0.0 ? static_cast<int>(k * range / pi) : 0;
  path.spreading = 1.0 / std::sqrt(range * std::abs(path.q));
  path.delay = range / water.c;
  path.path_length = range;
  path.horizontal_slowness = 1.0 / water.c;
  path.absorption_db =
      1e-3 *
      (absorption_db_per_km(ocean.absorption, frequency) + ocean.attenuation_db_per_km.at(0.0)) *
      range;
  path.amplitude =
      path.spreading * amplitude_from_db(-path.absorption_db) * caustic_phase(path.caustics);
  return path;
}

FanLimits fan_of(const PathLimits& limits) {
  return {.lowest = -limits.max_launch_angle,
          .highest = limits.max_launch_angle,
          .max_surface_bounces = limits.max_surface_bounces,
          .max_bottom_bounces = limits.max_bottom_bounces,
          .max_turns = limits.max_vertices,
          .faintest = limits.faintest};
}

void sort_and_drop_doubles(Arrivals& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return a.delay != b.delay ? a.delay < b.delay : a.launch_elevation < b.launch_elevation;
  });
  const auto same = [](const Arrival& a, const Arrival& b) {
    return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
           a.upper_turns + a.lower_turns == b.upper_turns + b.lower_turns &&
           std::abs(a.launch_elevation - b.launch_elevation) < same_root &&
           std::abs(a.delay - b.delay) < same_root;
  };
  arrivals.erase(std::unique(arrivals.begin(), arrivals.end(), same), arrivals.end());
}

}  // namespace

/// The tracers of an environment by frequency: a sonar works at a few.
struct EigenraySolver::Tracers {
  std::mutex mutex;
  std::map<double, std::shared_ptr<const RayTracer>> of;
};

EigenraySolver::EigenraySolver(const Environment& environment)
    : environment_(environment),
      layered_(is_layered(environment)),
      tracers_(std::make_shared<Tracers>()) {
  std::vector<double> ranges = {0.0};  // where the boundaries are nearest to each other
  for (const Boundary* boundary : {&environment.surface, &environment.bottom})
    if (boundary->shape)
      ranges.insert(ranges.end(), boundary->shape->ranges().begin(),
                    boundary->shape->ranges().end());
  for (const double range : ranges) {
    const double top = environment.surface.depth_at(range),
                 bottom = environment.bottom.depth_at(range);
    if (!(bottom > top))
      throw InputError(
          {.where = "bottom.depth",
           .got = std::to_string(bottom) + " m" +
                  (ranges.size() > 1 ? " at a range of " + std::to_string(range) + " m" : ""),
           .expected = "a depth below the surface at " + std::to_string(top) + " m"});
  }
  if (layered_)
    layers_ = make_layers(environment.water, environment.surface.depth, environment.bottom.depth);
}

std::shared_ptr<const RayTracer> EigenraySolver::tracer(double frequency) const {
  const std::lock_guard lock(tracers_->mutex);
  auto& tracer = tracers_->of[frequency];
  if (!tracer) tracer = std::make_shared<const RayTracer>(environment_, frequency);
  return tracer;
}

std::vector<Arrivals> EigenraySolver::find(double source_depth,
                                           std::span<const ReceiverPoint> receivers,
                                           double frequency, const PathLimits& limits) const {
  if (!layered_)
    return marching_eigenrays(*tracer(frequency), 0.0, source_depth, receivers, fan_of(limits));
  // one fan for each depth
  std::map<double, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < receivers.size(); ++i) rows[receivers[i].depth].push_back(i);
  const std::vector<std::pair<double, std::vector<std::size_t>>> work(rows.begin(), rows.end());
  std::vector<Arrivals> found(receivers.size());
  tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t row) {
    std::vector<double> ranges;
    for (const std::size_t i : work[row].second) ranges.push_back(receivers[i].range);
    std::vector<Arrivals> here = find(source_depth, work[row].first, ranges, frequency, limits);
    for (std::size_t i = 0; i < here.size(); ++i) found[work[row].second[i]] = std::move(here[i]);
  });
  return found;
}

BranchTable EigenraySolver::table(double source_depth, double receiver_depth,
                                  const PathLimits& limits) const {
  if (source_depth == receiver_depth) {
    const bool room_below = receiver_depth + depth_offset < environment_.bottom.depth;
    receiver_depth += room_below ? depth_offset : -depth_offset;
  }
  return {Column(layers_, source_depth, receiver_depth), limits, &environment_};
}

Arrivals EigenraySolver::find(double source_depth, double receiver_depth, double range,
                              double frequency, const PathLimits& limits) const {
  return std::move(
      find(source_depth, receiver_depth, std::span(&range, 1), frequency, limits).front());
}

std::vector<Arrivals> EigenraySolver::find(double source_depth, double receiver_depth,
                                           std::span<const double> ranges, double frequency,
                                           const PathLimits& limits) const {
  if (!layered_) {
    std::vector<ReceiverPoint> points;
    for (const double range : ranges) points.push_back({range, receiver_depth});
    return marching_eigenrays(*tracer(frequency), 0.0, source_depth, points, fan_of(limits));
  }
  std::vector<Arrivals> found(ranges.size());
  if (ranges.empty()) return found;
  std::vector<std::size_t> order(ranges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return ranges[a] < ranges[b]; });

  const auto range_of = [&](std::size_t i) { return std::max(ranges[order[i]], least_range); };

  const BranchTable fan = table(source_depth, receiver_depth, limits);
  const PathBuilder builder(environment_, fan.column(), frequency);
  RootSource roots(fan, builder);
  fan.for_each_stretch(
      range_of(0), range_of(order.size() - 1), [&](const MonotoneStretch& stretch) {
        const double low = std::min(stretch.range_begin, stretch.range_end),
                     high = std::max(stretch.range_begin, stretch.range_end);
        // A stretch owns its slow end, so that a root on a common end is found once.
        const auto first = std::partition_point(order.begin(), order.end(), [&](std::size_t i) {
          return std::max(ranges[i], least_range) < low;
        });
        const auto last = std::partition_point(first, order.end(), [&](std::size_t i) {
          return std::max(ranges[i], least_range) <= high;
        });
        const auto count = static_cast<std::size_t>(last - first);
        for (auto it = first; it != last; ++it) {
          const double range = std::max(ranges[*it], least_range);
          Arrival path = roots.at(stretch, range, count);
          if (ranges[*it] < least_range) raise(path, ranges[*it] / least_range, fan.column());
          if (std::isfinite(path.delay) && std::isfinite(path.spreading) &&
              std::abs(path.reflection) >= limits.faintest)
            found[*it].push_back(std::move(path));
        }
      });
  const bool along_a_level =
      source_depth == receiver_depth && environment_.water.at(source_depth).dc_dz == 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (along_a_level && ranges[i] > 0.0) {
      // Rays that stay within centimetres of the level are this one, seen through rounding.
      std::erase_if(found[i], [](const Arrival& a) { return std::abs(a.launch_elevation) < 1e-5; });
      found[i].push_back(horizontal_ray(environment_, source_depth, ranges[i], frequency));
    }
    sort_and_drop_doubles(found[i]);
  }
  return found;
}

}  // namespace asdic
