#include "raytrace/layered/root_search.h"

#include <algorithm>
#include <numeric>

namespace asdic::detail {
namespace {

template <class Field>
Rays gather(const SimdTasks& tasks, const Field& field) noexcept {
  return Rays([&](auto i) { return field(*tasks.task[i]); });
}

/// The cubic through both ends of each task's piece, over t from 0 to 1, in its variable x.
class SimdCubics {
 public:
  explicit SimdCubics(const SimdTasks& tasks) noexcept
      : steep_(gather(tasks, [](const RootTask& t) { return t.piece->steep ? 1.0 : 0.0; }) > 0.5),
        low_(gather(tasks, [](const RootTask& t) { return t.piece->begin.x; })),
        high_(gather(tasks, [](const RootTask& t) { return t.piece->end.x; })),
        a0_(gather(tasks, [](const RootTask& t) { return t.piece->begin.value; })) {
    const Rays h = high_ - low_;
    const Rays from = h * gather(tasks, [](const RootTask&t) { return t.piece->begin.slope; }),
               to = h * gather(tasks, [](const RootTask&t) { return t.piece->end.slope; });
    rise_ = gather(tasks, [](const RootTask& t) { return t.piece->end.value; }) - a0_;
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

  [[nodiscard]] Rays low() const noexcept { return sigma(low_); }
  [[nodiscard]] Rays high() const noexcept { return sigma(high_); }
  [[nodiscard]] Rays root() const noexcept { return sigma(low_ + t_ * (high_ - low_)); }
  [[nodiscard]] Rays::mask_type rises() const noexcept { return rise_ > 0.0; }
  [[nodiscard]] Rays::mask_type steep() const noexcept { return steep_; }
  /// |d²r/dx²| at the root.
  [[nodiscard]] Rays bend() const noexcept {
    const Rays h = high_ - low_;
    return abs(2.0 * a2_ + 6.0 * t_ * a3_) / (h * h);
  }

 private:
  [[nodiscard]] Rays sigma(const Rays& x) const noexcept {
    Rays s = x;
    where(steep_, s) = sqrt((1.0 - x) * (1.0 + x));
    return s;
  }

  Rays::mask_type steep_;
  Rays low_, high_, a0_, a1_, a2_, a3_, rise_, t_;
};

/// One step of Newton's method for r(x) = range, x = σ = sin θ or, of steep rays, −k = −ξ·c_ref =
/// −cos θ. dr/dσ = −σ·(dr/dξ)/(ξc_ref²), dr/dk = (dr/dξ)/c_ref.
struct Step {
  Rays next;             ///< σ
  Rays::mask_type last;  ///< it leaves less than 0.1 mm, and less than 1e-8 of the slope

  Step(const SimdRays& rays, const Rays& miss, const Rays& d_range, const Rays::mask_type& steep,
       const Rays& bend) noexcept {
    const double c_ref = rays.reference_speed;
    Rays slope = -rays.sigma * d_range * rays.per_c2 / rays.slowness;
    where(steep, slope) = -d_range / c_ref;
    const Rays by = -miss / slope;
    // What a step leaves is ½r″δ², seen on the cubic; its share of the step, r″δ/2r′, squared, is
    // that of the slope's error.
    const Rays left = 2.0 * bend * by * by;
    last = left < 1e-4 && left * bend < 1e-8 * slope * slope;
    next = rays.sigma + by;
    if (none_of(steep)) return;
    const Rays x = by - c_ref * rays.slowness;
    where(steep, next) = sqrt(max((1.0 - x) * (1.0 + x), Rays(0.0)));
    where(steep && abs(by) > 1e-3 * c_ref * rays.slowness, last) = Rays::mask_type(false);
  }
};

}  // namespace

RootPiece::RootPiece(const MonotonePiece& piece, bool source_is_upper) noexcept
    : interval(piece.interval),
      cell(piece.cell),
      branch(piece.branch),
      weights(asdic::detail::weights(piece.branch, source_is_upper)),
      steep(piece.sigma_begin > steep_sigma),
      begin{piece.sigma_begin, piece.range_begin, piece.slope_begin},
      end{piece.sigma_end, piece.range_end, piece.slope_end} {
  if (!steep) return;
  begin = in_cosine(begin);
  end = in_cosine(end);
}

SimdTasks::SimdTasks(const RootTask* const* tasks, std::size_t n) noexcept : count(n) {
  for (std::size_t i = 0; i < rays_at_once; ++i) task[i] = tasks[std::min(i, n - 1)];
  range = Rays([&](auto i) { return task[i]->range; });
  up = Rays([&](auto i) { return task[i]->piece->weights.up; });
  middle = Rays([&](auto i) { return task[i]->piece->weights.middle; });
  down = Rays([&](auto i) { return task[i]->piece->weights.down; });
}

FoundRays find_roots(const LegSource& source, double c_ref, const SimdTasks& tasks) noexcept {
  const SimdCubics cubic(tasks);
  const Rays bend = cubic.bend();
  const auto rises = cubic.rises();
  Rays low = cubic.low(), high = cubic.high(), sigma = cubic.root();
  Rays::mask_type done(false);
  for (int i = 0; i < 100; ++i) {
    const SimdRays rays(c_ref, sigma);
    const SimdColumn legs = source.sums(rays);
    const Rays d_range = tasks.of(legs.up.d_range, legs.middle.d_range, legs.down.d_range);
    const Rays miss = rays.slowness * tasks.of(legs.up.per_slowness, legs.middle.per_slowness,
                                               legs.down.per_slowness) -
                      tasks.range;
    const auto short_of = (miss < 0.0) == rises;
    where(short_of, low) = sigma;
    where(!short_of, high) = sigma;
    Step step(rays, miss, d_range, cubic.steep(), bend);
    const auto outside = !(step.next > low && step.next < high);
    where(outside, step.next) = 0.5 * (low + high);
    where(abs(miss) < 1e-5 || high - low < 1e-16 * high, step.next) = sigma;
    where(!done, sigma) = step.next;
    done = done || (step.last && !outside) || step.next == rays.sigma;
    if (all_of(done)) break;
  }
  const SimdRays rays(c_ref, sigma);
  return {rays, source.all(rays)};
}

RootGroups::RootGroups(const BranchTable& fan, const FanInterval& interval,
                       std::span<const RootTask> tasks)
    : column_(fan.column()),
      kept_(fan.kept()),
      interval_(interval),
      series_(fan.column(), interval.reference_speed,
              tasks.size() < worth_a_series ? std::span<const double>() : interval.sigma),
      order_(tasks.size()) {
  std::vector<std::size_t> next(interval.sigma.size() + 1, 0);  // place of each cell's first task
  for (const RootTask& task : tasks) ++next[task.piece->cell + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (const RootTask& task : tasks) order_[next[task.piece->cell]++] = &task;
}

std::size_t RootGroups::first_at(std::size_t begin, std::size_t cell) const noexcept {
  std::size_t i = begin;
  while (i < order_.size() && order_[i]->piece->cell < cell) ++i;
  return i;
}

/// Too few for a series of their own: with walks, or as many as the ocean's piece of the first one
/// holds for.
RootGroups::Group RootGroups::few(std::size_t begin, std::size_t end) const {
  if (kept_ == nullptr) return {{.column = column_}, end};
  const auto ocean_piece = [&](const RootTask& task) {
    const HermiteNode &a = task.piece->begin, &b = task.piece->end;
    double x = a.x + (b.x - a.x) * (task.range - a.value) / (b.value - a.value);
    if (const double root = Hermite(a, b).root_near(x, task.range); root > a.x && root < b.x)
      x = root;
    return kept_->find(interval_.reference_speed, task.piece->steep ? sine_of_cosine(x) : x);
  };
  const OceanSeries::Found first = ocean_piece(*order_[begin]);
  std::size_t i = begin + 1;
  while (i < end && ocean_piece(*order_[i]) == first) ++i;
  return {{.column = column_, .kept = kept_, .found = first}, i};
}

RootGroups::Group RootGroups::next(std::size_t begin) {
  if (order_.size() < worth_a_series) return few(begin, order_.size());
  const std::size_t cell = order_[begin]->piece->cell;
  for (;;) {
    const IntervalSeries::Cells cells = series_.around(cell);
    const std::size_t end = first_at(begin, cells.last);
    if (end - begin < worth_a_series) return few(begin, end);
    const LegSeries* series = series_.at(cell);
    const IntervalSeries::Cells now = series_.around(cell);
    if (now.last == cells.last) return {{.column = column_, .series = series}, end};
  }
}

}  // namespace asdic::detail
