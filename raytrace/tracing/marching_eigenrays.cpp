#include "raytrace/tracing/marching_eigenrays.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/units.h"
#include "raytrace/tracing/neighbours.h"
#include "raytrace/tracing/root_finder.h"

namespace asdic {
namespace {

/// A receiver (almost) straight above or below is met by (almost) vertical rays; they are found at
/// this range and then put upright, as in the layered solver (eigenrays.cpp) [m].
constexpr double least_range = 0.1;

/// Roots closer than this are one [rad, s].
constexpr double same_root = 1e-9;

constexpr int first_intervals = 256;
constexpr int deepest_split = 60;

/// Tracing goes on behind the last column until the next boundary is met, mostly; and as far as
/// there are slopes that can send a ray back.
double beyond_last_column(const Environment& ocean, double last) {
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const double top = ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth;
  double end = last + 2.0 * (bottom - top);
  for (const Boundary* boundary : {&ocean.surface, &ocean.bottom})
    if (boundary->shape) end = std::max(end, boundary->shape->ranges().back());
  return end;
}

/// And before the first.
double before_first_column(const Environment& ocean, double first) {
  double end = first;
  for (const Boundary* boundary : {&ocean.surface, &ocean.bottom})
    if (boundary->shape) end = std::min(end, boundary->shape->ranges().front());
  return end - 1.0;
}

/// Launch angles of the first rays: three times denser about the horizontal, where rays are bent
/// most.
double first_angle(const FanLimits& limits, int i) {
  const double u = double(i) / first_intervals;  // 0..1
  const double v = 2.0 * u - 1.0;
  const double w = 0.5 * (1.0 + v * (0.5 + 0.5 * v * v));
  return i == 0                 ? limits.lowest
         : i == first_intervals ? limits.highest
                                : limits.lowest + (limits.highest - limits.lowest) * w;
}

struct Hit {
  std::uint32_t receiver;
  Arrival path;
};

/// One thread's memory.
struct Workspace {
  Workspace(const RayTracer& tracer, double range, double depth, const TraceLimits& limits,
            std::span<const ReceiverColumn> columns)
      : roots(tracer, range, depth, limits, columns) {}
  RootFinder roots;
  RayTrajectory trajectory;
  std::deque<FanRay> rays;  // by depth of splitting
};

class FanSearch {
 public:
  FanSearch(const RayTracer& tracer, double source_range, double source_depth,
            std::span<const ReceiverColumn> columns, const FanLimits& limits)
      : tracer_(tracer),
        source_range_(source_range),
        source_depth_(source_depth),
        columns_(columns),
        limits_(limits),
        test_(columns) {
    trace_limits_ = {.max_depth = limits.max_depth,
                     .max_surface_bounces = limits.max_surface_bounces,
                     .max_bottom_bounces = limits.max_bottom_bounces,
                     .faintest = limits.faintest};
    const Environment& ocean = tracer.environment();
    trace_limits_.max_range =
        std::min(limits.max_range, beyond_last_column(ocean, columns.back().range));
    // Receivers at the edge of the box are in it.
    trace_limits_.max_range = std::max(trace_limits_.max_range, columns.back().range + 1.0);
    trace_limits_.min_range =
        std::max(limits.min_range,
                 before_first_column(ocean, std::min(source_range, columns.front().range)));
  }

  std::vector<Hit> run() const {
    std::vector<std::vector<Hit>> hits(first_intervals);
    tbb::enumerable_thread_specific<Workspace> workspaces([this] {
      return Workspace(tracer_, source_range_, source_depth_, trace_limits_, columns_);
    });
    tbb::parallel_for(0, first_intervals, [&](int i) {
      Workspace& work = workspaces.local();
      if (work.rays.empty()) work.rays.resize(2);
      trace(first_angle(limits_, i), work, work.rays[0]);
      trace(first_angle(limits_, i + 1), work, work.rays[1]);
      split(work.rays[0], work.rays[1], 2, work, hits[static_cast<std::size_t>(i)]);
    });
    std::vector<Hit> all;
    for (auto& some : hits) std::move(some.begin(), some.end(), std::back_inserter(all));
    return all;
  }

 private:
  void trace(double angle, Workspace& work, FanRay& out) const {
    tracer_.trace(source_range_, source_depth_, angle, trace_limits_, work.trajectory);
    digest(work.trajectory, tracer_.environment(), columns_, out);
  }

  /// \param slot  of the ray in the middle in the thread's memory
  void split(const FanRay& a, const FanRay& b, std::size_t slot, Workspace& work,
             std::vector<Hit>& hits) const {
    if (work.rays.size() <= slot) work.rays.emplace_back();
    FanRay& m = work.rays[slot];  // a deque: references stay
    const double middle = 0.5 * (a.angle + b.angle);
    if (!(middle > a.angle && middle < b.angle)) return search(a, b, work, hits);
    trace(middle, work, m);
    if (slot < deepest_split && !test_.holds(a, m, b)) {
      split(a, m, slot + 1, work, hits);
      split(m, b, slot + 1, work, hits);
    } else {
      search(a, m, work, hits);
      search(m, b, work, hits);
    }
  }

  void search(const FanRay& a, const FanRay& b, Workspace& work, std::vector<Hit>& hits) const {
    work.roots.search(a, b, limits_.max_turns, [&](std::uint32_t receiver, Arrival&& path) {
      hits.push_back({receiver, std::move(path)});
    });
  }

  const RayTracer& tracer_;
  double source_range_, source_depth_;
  std::span<const ReceiverColumn> columns_;
  FanLimits limits_;
  TraceLimits trace_limits_;
  NeighbourTest test_;
};

void sort_and_drop_doubles(Arrivals& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return a.delay != b.delay ? a.delay < b.delay : a.launch_elevation < b.launch_elevation;
  });
  const auto same = [](const Arrival& a, const Arrival& b) {
    return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
           std::abs(a.launch_elevation - b.launch_elevation) < same_root &&
           std::abs(a.delay - b.delay) < same_root;
  };
  arrivals.erase(std::unique(arrivals.begin(), arrivals.end(), same), arrivals.end());
}

/// A path found at the least range, for a receiver closer to the vertical: every horizontal step
/// shrinks in proportion.
void raise(Arrival& path, double share) {
  path.horizontal_slowness *= share;
  for (double* angle : {&path.launch_elevation, &path.arrival_elevation})
    *angle = std::copysign(std::acos(share * std::cos(*angle)), *angle);
  for (Bounce& bounce : path.bounces) bounce.range *= share;
}

}  // namespace

std::vector<Arrivals> marching_eigenrays(const RayTracer& tracer, double source_range,
                                         double source_depth,
                                         std::span<const ReceiverPoint> receivers,
                                         const FanLimits& limits) {
  std::vector<Arrivals> found(receivers.size());
  if (receivers.empty()) return found;
  std::vector<ReceiverPoint> points(receivers.begin(), receivers.end());
  for (ReceiverPoint& point : points)
    if (std::abs(point.range - source_range) < least_range)
      point.range = source_range + least_range;
  const std::vector<ReceiverColumn> columns = make_columns(points);
  for (Hit& hit : FanSearch(tracer, source_range, source_depth, columns, limits).run()) {
    const double offset = std::abs(receivers[hit.receiver].range - source_range);
    if (offset < least_range) raise(hit.path, offset / least_range);
    found[hit.receiver].push_back(std::move(hit.path));
  }
  for (Arrivals& arrivals : found) sort_and_drop_doubles(arrivals);
  return found;
}

}  // namespace asdic
