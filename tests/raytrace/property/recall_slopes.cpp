#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "raytrace/tracing/marching_eigenrays.h"
#include "raytrace/tracing/ray_tracer.h"
#include "support/deep.h"
#include "support/sloping_seas.h"
#include "support/test_id.h"

// None missed over slopes of 10–60 km: the search against 20 000 rays, 200 000 in the deep check;
// every two neighbours that pass a receiver on either side after the same bounces. What neighbours
// of different families only seem to enclose is told from a root by halving. (The rays' own
// correctness: raytrace_tracer.cpp, against an independent integrator.)
namespace asdic::detail {
namespace {

const int rays = support::deep() ? 200'000 : 20'000;

struct Pass {
  std::size_t column;
  double depth;
  int surface, bottom, turns;
};

/// Where one ray passes the columns.
class Passes final : public RangeVisitor {
 public:
  std::vector<Pass> all;
  void pass(std::size_t column, const RayState& y, const RayHistory& h) override {
    all.push_back(
        {column, y.depth, h.surface_bounces, h.bottom_bounces, h.upper_turns + h.lower_turns});
  }
  /// After the same bounces, at the same column; the n-th of those.
  [[nodiscard]] const Pass* like(const Pass& wanted, std::size_t n) const {
    for (const Pass& p : all)
      if (p.column == wanted.column && p.surface == wanted.surface && p.bottom == wanted.bottom &&
          n-- == 0)
        return &p;
    return nullptr;
  }
  /// Which of those like it a pass is.
  [[nodiscard]] std::size_t number(std::size_t i) const {
    std::size_t n = 0;
    for (std::size_t k = 0; k < i; ++k)
      n += all[k].column == all[i].column && all[k].surface == all[i].surface &&
           all[k].bottom == all[i].bottom;
    return n;
  }
};

class SlopingRecallSlow : public testing::TestWithParam<support::SlopingSea> {
 protected:
  void trace(const RayTracer& tracer, double angle, Passes& out) const {
    const support::SlopingSea& slope = GetParam();
    out.all.clear();
    tracer.trace_past(slope.ranges, 0.0, slope.source_depth, angle,
                      {.min_range = -1.0,
                       .max_range = slope.ranges.back() + 1.0,
                       .max_surface_bounces = slope.bounces + 1,
                       .max_bottom_bounces = slope.bounces + 1},
                      out);
  }
  /// The launch angle between two at which a ray like theirs passes a depth; nothing where rays of
  /// two families pass it on either side.
  std::optional<double> root(const RayTracer& tracer, double low, double high, const Pass& below,
                             std::size_t n, double depth) const {
    Passes here;
    double gap_low = 1e300, gap_high = 1e300;
    const auto side = [&](double angle, double& gap) -> std::optional<bool> {
      trace(tracer, angle, here);
      const Pass* there = here.like(below, n);
      if (there == nullptr) return std::nullopt;
      gap = there->depth - depth;
      return there->depth > depth;
    };
    const auto first = side(low, gap_low), last = side(high, gap_high);
    if (!first || !last || *first == *last) return std::nullopt;
    for (int i = 0; i < 60 && std::max(std::abs(gap_low), std::abs(gap_high)) > 1e-4; ++i) {
      const double middle = 0.5 * (low + high);
      double gap = 0.0;
      const auto there = side(middle, gap);
      if (!there) return std::nullopt;
      (*there == *first ? low : high) = middle;
      (*there == *first ? gap_low : gap_high) = gap;
    }
    if (std::min(std::abs(gap_low), std::abs(gap_high)) > 1e-3) return std::nullopt;
    return 0.5 * (low + high);
  }
};
INSTANTIATE_TEST_SUITE_P(Search, SlopingRecallSlow, testing::ValuesIn(support::sloping_seas()),
                         [](const auto& test) { return support::test_id(test.param.name); });

TEST_P(SlopingRecallSlow, AFanOfVeryManyRaysFindsNoMore) {
  const support::SlopingSea& slope = GetParam();
  const RayTracer tracer(slope.ocean, 1000.0);
  std::vector<ReceiverPoint> receivers;
  for (const double r : slope.ranges)
    for (const double z : slope.depths) receivers.push_back({r, z});
  // one receiver after the other: a search for all of them at once has a finer fan
  std::vector<Arrivals> found(receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    found[i] = marching_eigenrays(tracer, 0.0, slope.source_depth, std::span(&receivers[i], 1),
                                  {.lowest = -slope.steepest,
                                   .highest = slope.steepest,
                                   .max_surface_bounces = slope.bounces,
                                   .max_bottom_bounces = slope.bounces})[0];
  }
  std::mutex mutex;
  std::size_t roots = 0, apart = 0;
  const auto angle_of = [&](int i) { return slope.steepest * (2.0 * (i + 0.5) / rays - 1.0); };
  const auto compare = [&](const Passes& a, double from, const Passes& b, double to) {
    for (std::size_t i = 0; i < a.all.size(); ++i) {
      const Pass& pa = a.all[i];
      if (pa.surface > slope.bounces || pa.bottom > slope.bounces) continue;
      const std::size_t n = a.number(i);
      const Pass* pb = b.like(pa, n);
      if (pb == nullptr) continue;
      for (std::size_t k = 0; k < slope.depths.size(); ++k) {
        const double depth = slope.depths[k];
        if ((pa.depth > depth) == (pb->depth > depth)) continue;
        const bool known =
            std::ranges::any_of(found[pa.column * slope.depths.size() + k], [&](const Arrival& x) {
              return x.launch_elevation > from - 1e-9 && x.launch_elevation < to + 1e-9 &&
                     x.surface_bounces == pa.surface && x.bottom_bounces == pa.bottom;
            });
        if (known) {
          const std::scoped_lock lock(mutex);
          ++roots;
          continue;
        }
        const auto missed = root(tracer, from, to, pa, n, depth);
        const std::scoped_lock lock(mutex);
        ++(missed ? roots : apart);
        EXPECT_FALSE(missed) << slope.ranges[pa.column] << " m, " << depth << " m, launched at "
                             << *missed << " after " << pa.surface << " + " << pa.bottom
                             << " bounces, " << pa.depth << " to " << pb->depth << " m";
      }
    }
  };
  tbb::parallel_for(tbb::blocked_range<int>(0, rays - 1, 500), [&](const auto& part) {
    Passes before, here;
    trace(tracer, angle_of(part.begin()), before);
    for (int i = part.begin(); i < part.end(); ++i) {
      trace(tracer, angle_of(i + 1), here);
      compare(before, angle_of(i), here, angle_of(i + 1));
      std::swap(before, here);
    }
  });
  EXPECT_GT(roots, 40U);
  RecordProperty("roots", static_cast<int>(roots));
  RecordProperty("of_two_families", static_cast<int>(apart));
}

}  // namespace
}  // namespace asdic::detail
