#include "raytrace/layered/root_search.h"

#include <algorithm>
#include <numeric>

namespace asdic {
namespace {

template <class Field>
Rays gather(const TaskLanes& tasks, const Field& field) noexcept {
  return Rays([&](auto i) { return field(*tasks.task[i]); });
}

/// The cubic through both ends of each task's stretch, over t from 0 to 1.
class CubicLanes {
 public:
  explicit CubicLanes(const TaskLanes& tasks) noexcept
      : low_(gather(tasks, [](const RootTask& t) { return t.begin.x; })),
        high_(gather(tasks, [](const RootTask& t) { return t.end.x; })),
        a0_(gather(tasks, [](const RootTask& t) { return t.begin.value; })) {
    const Rays h = high_ - low_;
    const Rays from = h * gather(tasks, [](const RootTask&t) { return t.begin.slope; }),
               to = h * gather(tasks, [](const RootTask&t) { return t.end.slope; });
    rise_ = gather(tasks, [](const RootTask& t) { return t.end.value; }) - a0_;
    a1_ = from;
    a2_ = 3.0 * rise_ - 2.0 * from - to;
    a3_ = from + to - 2.0 * rise_;
    t_ = min(max((tasks.range - a0_) / rise_, Rays(0.0)), Rays(1.0));
    for (int i = 0; i < 4; ++i) {
      const Rays off = a0_ - tasks.range + t_ * (a1_ + t_ * (a2_ + t_ * a3_));
      const Rays next = t_ - off / (a1_ + t_ * (2.0 * a2_ + 3.0 * t_ * a3_));
      where(next > 0.0 && next < 1.0, t_) = next;  // not if it is no number
    }
  }

  [[nodiscard]] const Rays& low() const noexcept { return low_; }
  [[nodiscard]] const Rays& high() const noexcept { return high_; }
  [[nodiscard]] Rays::mask_type rises() const noexcept { return rise_ > 0.0; }
  [[nodiscard]] Rays root() const noexcept { return low_ + t_ * (high_ - low_); }
  /// |r″| at the root.
  [[nodiscard]] Rays bend() const noexcept {
    const Rays h = high_ - low_;
    return abs(2.0 * a2_ + 6.0 * t_ * a3_) / (h * h);
  }

 private:
  Rays low_, high_, a0_, a1_, a2_, a3_, rise_, t_;
};

/// One step of Newton's method for r(σ) = range, in the smaller of σ = sin θ and k = ξ·c_ref = cos
/// θ: near the vertical r goes like k. dr/dσ = −σ·(dr/dξ)/(ξc_ref²), dr/dk = (dr/dξ)/c_ref.
Rays step(const RayLanes& rays, const Rays& miss, const Rays& slope, const Rays& d_range) noexcept {
  Rays next = rays.sigma - miss / slope;
  const Rays k = rays.reference_speed * (rays.slowness - miss / d_range);
  where(rays.sigma > 0.7, next) = sqrt(max((1.0 - k) * (1.0 + k), Rays(0.0)));
  return next;
}

}  // namespace

TaskLanes::TaskLanes(const RootTask* const* tasks, std::size_t n, bool source_is_upper) noexcept
    : count(n) {
  std::array<BranchWeights, rays_at_once> w;
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    task[i] = tasks[std::min(i, n - 1)];
    w[i] = weights(task[i]->branch, source_is_upper);
  }
  range = Rays([&](auto i) { return task[i]->range; });
  up = Rays([&](auto i) { return w[i].up; });
  middle = Rays([&](auto i) { return w[i].middle; });
  down = Rays([&](auto i) { return w[i].down; });
}

FoundRays find_roots(const Column& column, double c_ref, const LegSeries* series,
                     const TaskLanes& tasks) noexcept {
  const CubicLanes cubic(tasks);
  const Rays bend = cubic.bend();
  const auto rises = cubic.rises();
  Rays low = cubic.low(), high = cubic.high(), sigma = cubic.root();
  for (int i = 0; i < 100; ++i) {
    const RayLanes rays(c_ref, sigma);
    const ColumnLanes legs = series != nullptr ? series->sums(rays) : walk_sums(column, rays);
    const Rays d_range = tasks.of(legs.up.d_range, legs.middle.d_range, legs.down.d_range);
    const Rays miss = rays.slowness * tasks.of(legs.up.per_slowness, legs.middle.per_slowness,
                                               legs.down.per_slowness) -
                      tasks.range;
    const Rays slope = -sigma * d_range * rays.per_c2 / rays.slowness;
    const auto short_of = (miss < 0.0) == rises;
    where(short_of, low) = sigma;
    where(!short_of, high) = sigma;
    Rays next = step(rays, miss, slope, d_range);
    where(!(next > low && next < high), next) = 0.5 * (low + high);
    // near the vertical, where r goes like k, no cubic tells what a step leaves
    const auto near_enough = abs(miss) < 1e-3 && abs(miss) < 3e-4 * tasks.range &&
                             bend * abs(miss) < 1e-8 * slope * slope;
    const auto done = abs(miss) < 1e-5 || near_enough || high - low < 1e-16 * high || next == sigma;
    if (all_of(done)) break;
    where(!done, sigma) = next;
  }
  const RayLanes rays(c_ref, sigma);
  return {rays, series != nullptr ? series->all(rays) : walk_all(column, rays)};
}

RootGroups::RootGroups(const Column& column, const FanInterval& interval,
                       std::span<const RootTask> tasks)
    : column_(column),
      interval_(interval),
      series_(column, interval.reference_speed, interval.sigma),
      order_(tasks.size()) {
  std::vector<std::size_t> next(interval.sigma.size() + 1, 0);  // place of each cell's first task
  for (const RootTask& task : tasks) ++next[task.cell + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (const RootTask& task : tasks) order_[next[task.cell]++] = &task;
}

std::size_t RootGroups::first_at(std::size_t begin, std::size_t cell) const noexcept {
  std::size_t i = begin;
  while (i < order_.size() && order_[i]->cell < cell) ++i;
  return i;
}

RootGroups::Group RootGroups::next(std::size_t begin) {
  const std::size_t cell = order_[begin]->cell;
  for (;;) {
    const IntervalSeries::Cells cells = series_.around(cell);
    const std::size_t end = first_at(begin, cells.last);
    if (end - begin < worth_a_series) return {nullptr, end};
    const LegSeries* series = series_.at(cell);
    const IntervalSeries::Cells now = series_.around(cell);
    if (now.last == cells.last) return {series, end};
  }
}

}  // namespace asdic
