#include "raytrace/paths/eigenrays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/layered/followed_branch.h"
#include "raytrace/layered/level_path.h"
#include "raytrace/layered/path_builder.h"
#include "raytrace/layered/root_search.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/tracing/marching_eigenrays.h"

namespace asdic::detail {
namespace {

/// Least distance in depth of source and receiver in the sums [m]. Ends that are closer are moved
/// apart to it, which changes no result by more than rounding.
constexpr double depth_offset = 1e-6;

/// Depth of the receiver in the sums [m]: in the water, at least `depth_offset` from the source's.
double summed_depth(double source_depth, double receiver_depth, const Environment& ocean) {
  const double off = receiver_depth - source_depth;
  if (std::abs(off) >= depth_offset) return receiver_depth;
  const bool below =
      source_depth +
      depth_offset<ocean.bottom.depth, above = source_depth - depth_offset> ocean.surface.depth;
  return source_depth + (below && (off >= 0.0 || !above) ? depth_offset : -depth_offset);
}

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

/// By delay; a root found twice (on the end that two pieces share) counts once.
void sort_and_drop_doubles(Arrivals& arrivals, std::vector<std::size_t>& order) {
  const auto same = [](const Arrival& a, const Arrival& b) {
    return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
           a.upper_turns + a.lower_turns == b.upper_turns + b.lower_turns &&
           std::abs(a.launch_elevation - b.launch_elevation) < same_root &&
           std::abs(a.delay - b.delay) < same_root;
  };
  // Arrivals are large: their order is found first, then each is moved once.
  order.resize(arrivals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return earlier(arrivals[a], arrivals[b]); });
  for (std::size_t start = 0; start < order.size(); ++start) {
    if (order[start] == start) continue;
    Arrival first = std::move(arrivals[start]);
    std::size_t i = start;
    while (order[i] != start) {
      arrivals[i] = std::move(arrivals[order[i]]);
      i = std::exchange(order[i], i);
    }
    arrivals[i] = std::move(first);
    order[i] = i;
  }
  arrivals.erase(std::unique(arrivals.begin(), arrivals.end(), same), arrivals.end());
}

FanLimits fan_of(const PathLimits& limits) {
  return {.lowest = -limits.max_launch_angle,
          .highest = limits.max_launch_angle,
          .max_surface_bounces = limits.max_surface_bounces,
          .max_bottom_bounces = limits.max_bottom_bounces,
          .max_turns = limits.max_vertices,
          .faintest = limits.faintest};
}

}  // namespace

/// The layers of a layered ocean, and what of them is worth keeping.
struct EigenraySolver::LayeredOcean {
  std::vector<Layer> layers;
  std::optional<OceanFan> fan;
  std::optional<OceanSeries> series;

  explicit LayeredOcean(std::vector<Layer> all) : layers(std::move(all)) {
    if (OceanSeries::worth_keeping(layers)) series.emplace(layers);
    const bool fan_by_series = series && layers.front().law == Layer::Law::munk;
    if (layers.size() <= OceanFan::most_layers && !fan_by_series) fan.emplace(layers);
  }
  [[nodiscard]] KeptOcean kept() const noexcept {
    return {.layers = layers, .fan = fan ? &*fan : nullptr, .series = series ? &*series : nullptr};
  }
};

namespace {

/// The last few of something by key. What is not made is not kept.
template <class Key, class Value, std::size_t most>
class LastFew {
 public:
  template <class Make>
  std::shared_ptr<const Value> of(const Key& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto known = std::ranges::find(kept_, key, &Kept::first);
      if (known != kept_.end()) return known->second;
    }
    std::shared_ptr<const Value> made = make();
    if (made == nullptr) return made;
    const std::lock_guard lock(mutex_);
    if (kept_.size() == most) kept_.erase(kept_.begin());
    kept_.emplace_back(key, made);
    return made;
  }

 private:
  using Kept = std::pair<Key, std::shared_ptr<const Value>>;
  std::mutex mutex_;
  std::vector<Kept> kept_;  // the latest last
};

}  // namespace

/// The last columns that paths were followed in: ends move, their depths seldom.
struct EigenraySolver::Columns {
  LastFew<std::pair<double, double>, WaterBetween, 4> by_depths;
};

namespace {

/// The rays of a search, before anything that depends on frequency is known of them.
struct SearchedRays {
  /// Pieces with the receivers between their ends, by range [first, last).
  struct Held {
    RootPiece piece;
    std::size_t first, last;
  };
  struct Batch {
    const FanInterval& interval;
    SimdTasks tasks;
    FoundRays rays;
  };

  std::shared_ptr<const BranchTable> fan;
  std::vector<Held> held;
  std::vector<RootTask> tasks;
  std::vector<std::size_t> expected;  // [receivers] number of rays
  std::vector<Batch> batches;         // where they are kept

  /// \param wanted  [n] ranges, increasing [m]   \param order  [n] whose they are
  SearchedRays(std::shared_ptr<const BranchTable> of, std::span<const double> wanted,
               std::span<const std::size_t> order)
      : fan(std::move(of)), expected(wanted.size(), 0) {
    std::size_t roots = 0;
    fan->for_each_piece(wanted, [&](const MonotonePiece& piece) {
      const auto [low, high] = std::minmax(piece.range_begin, piece.range_end);
      const auto first = std::lower_bound(wanted.begin(), wanted.end(), low),
                 last = std::upper_bound(first, wanted.end(), high);
      if (first == last) return;
      held.push_back({.piece = {piece, fan->column().source_is_upper()},
                      .first = static_cast<std::size_t>(first - wanted.begin()),
                      .last = static_cast<std::size_t>(last - wanted.begin())});
      roots += held.back().last - held.back().first;
    });
    tasks.reserve(roots);
    for (const auto& [piece, first, last] : held)
      for (std::size_t i = first; i < last; ++i) {
        tasks.push_back({.piece = &piece, .receiver = order[i], .range = wanted[i]});
        ++expected[order[i]];
      }
  }
  /// Calls found(FanInterval, SimdTasks, FoundRays) with every batch.
  template <class Found>
  void solve(const Found& found) const {
    for (auto begin = tasks.begin(); begin != tasks.end();) {  // pieces come interval by interval
      const FanInterval& interval = *begin->piece->interval;
      const auto end = std::find_if(
          begin, tasks.end(), [&](const RootTask& t) { return t.piece->interval != &interval; });
      RootGroups(*fan, interval, std::span(begin, end))
          .solve(
              [&](const SimdTasks& batch, const FoundRays& rays) { found(interval, batch, rays); });
      begin = end;
    }
  }
};

/// All numbers of limits.
auto numbers_of(const PathLimits& limits) {
  const auto& [surface, bottom, angle, most, least, diffraction, faintest, delay, home] = limits;
  return std::tuple(surface, bottom, angle, most, least, diffraction, faintest, delay, home);
}
using FanKey = std::tuple<double, double, decltype(numbers_of(PathLimits{}))>;

}  // namespace

/// The last fans, and the last rays to one receiver: waves over a band ask for those at each of its
/// frequencies, and the rays are the same.
struct EigenraySolver::Searches {
  /// Rays of a search that is kept at most, each some 300 bytes: all together take 10 MB.
  static constexpr std::size_t most_rays = 1024;
  LastFew<FanKey, BranchTable, 8> fans;
  LastFew<std::pair<FanKey, double>, SearchedRays, 32> rays;
};

/// The tracers of an environment by frequency: a sonar works at a few.
struct EigenraySolver::Tracers {
  std::mutex mutex;
  std::map<double, std::shared_ptr<const RayTracer>> of;
};

EigenraySolver::EigenraySolver(const Environment& environment)
    : environment_(environment),
      layered_(is_layered(environment)),
      tracers_(std::make_shared<Tracers>()),
      columns_(std::make_shared<Columns>()),
      searches_(std::make_shared<Searches>()) {
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
    water_ = std::make_shared<const LayeredOcean>(
        make_layers(environment.water, environment.surface.depth, environment.bottom.depth));
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
  const auto search = [&](std::size_t row) {
    std::vector<double> ranges;
    for (const std::size_t i : work[row].second) ranges.push_back(receivers[i].range);
    std::vector<Arrivals> here = find(source_depth, work[row].first, ranges, frequency, limits);
    for (std::size_t i = 0; i < here.size(); ++i) found[work[row].second[i]] = std::move(here[i]);
  };
  // A row takes less time than waking threads.
  if (work.size() == 1)
    search(0);
  else
    in_parallel(work.size(), search);
  return found;
}

std::shared_ptr<const BranchTable> EigenraySolver::table(double source_depth, double receiver_depth,
                                                         const PathLimits& limits) const {
  const double there = summed_depth(source_depth, receiver_depth, environment_);
  return searches_->fans.of({source_depth, there, numbers_of(limits)}, [&] {
    return std::make_shared<BranchTable>(Column(water_->layers, source_depth, there), limits,
                                         &environment_, water_->kept());
  });
}

std::optional<Arrival> EigenraySolver::follow(const Arrival& known, double source_depth,
                                              double receiver_depth, double range, double frequency,
                                              const PathLimits& limits) const {
  const bool flat = is_flat(known, environment_.water.at(source_depth));
  if (!layered_ || flat || !(range >= least_range)) return std::nullopt;
  receiver_depth = summed_depth(source_depth, receiver_depth, environment_);
  const auto water = columns_->by_depths.of({source_depth, receiver_depth}, [&] {
    return std::make_shared<const WaterBetween>(source_depth, receiver_depth, water_->kept());
  });
  return followed_branch(environment_, *water, range, frequency, known, limits);
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
  if (ranges.empty()) return {};
  std::vector<std::size_t> order(ranges.size());  // by range
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranges[a] < ranges[b]; });
  std::vector<double> wanted;
  wanted.reserve(ranges.size());
  for (const std::size_t i : order) wanted.push_back(std::max(ranges[i], least_range));

  const std::shared_ptr<const BranchTable> fan = table(source_depth, receiver_depth, limits);
  const PathBuilder builder(environment_, fan->column(), frequency);
  std::vector<Arrivals> found(ranges.size());
  const auto reserve = [&](const SearchedRays& rays) {
    for (std::size_t i = 0; i < found.size(); ++i) found[i].reserve(rays.expected[i]);
  };
  const auto build = [&](const FanInterval& interval, const SimdTasks& batch,
                         const FoundRays& rays) {
    builder.build(interval, batch, rays, limits.faintest, found);
  };
  if (ranges.size() > 1) {
    const SearchedRays rays(fan, wanted, order);
    reserve(rays);
    rays.solve(build);
  } else {
    const FanKey between{source_depth, summed_depth(source_depth, receiver_depth, environment_),
                         numbers_of(limits)};
    std::shared_ptr<const SearchedRays> too_many;
    auto rays =
        searches_->rays.of({between, wanted.front()}, [&]() -> std::shared_ptr<const SearchedRays> {
          auto made = std::make_shared<SearchedRays>(fan, wanted, order);
          made->solve(
              [&](const FanInterval& interval, const SimdTasks& batch, const FoundRays& one) {
                made->batches.push_back({interval, batch, one});
              });
          if (made->tasks.size() <= Searches::most_rays) return made;
          too_many = made;
          return nullptr;
        });
    if (rays == nullptr) rays = too_many;
    reserve(*rays);
    for (const auto& [interval, batch, one] : rays->batches) build(interval, batch, one);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (ranges[i] < least_range)
      for (Arrival& path : found[i]) raise(path, ranges[i] / least_range, fan->column());
    sort_and_drop_doubles(found[i], order);
  }

  put_level_paths(environment_, frequency, source_depth, receiver_depth, ranges, found);
  return found;
}

}  // namespace asdic::detail
