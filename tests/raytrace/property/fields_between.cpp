#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <optional>
#include <random>

#include "raytrace/beams/convergence.h"
#include "raytrace/beams/rays_between.h"
#include "raytrace/runs/field_run.h"
#include "raytrace/runs/path_field.h"
#include "support/deep.h"

// Fields with less tracing: rays between traced ones, and sums of paths instead of beams.
namespace asdic::detail {
namespace {

/// Water whose rays are marched: smooth laws over a flat bottom, or lines over a slope, a smooth
/// ridge, facets, under swell.
PropagationCase random_sea(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  PropagationCase run_case;
  const double bottom = draw(100.0, 800.0), last = draw(15.0, 40.0) * bottom;
  std::vector<double> depth = {0.0}, speed = {draw(1490.0, 1520.0)};
  while (depth.back() < 1.3 * bottom) {
    depth.push_back(depth.back() + bottom * draw(0.1, 0.3));
    speed.push_back(speed.back() + draw(-8.0, 8.0));
  }
  const unsigned kind = seed % 6;
  const Interpolation law = kind == 0   ? Interpolation::spline
                            : kind == 1 ? Interpolation::pchip
                                        : Interpolation::c_linear;
  run_case.environment.water = SoundSpeedProfile::table(depth, speed, law);
  run_case.environment.bottom = {
      .depth = bottom,
      .material = FluidHalfSpace{.speed = draw(1600.0, 1900.0), .density = 1900.0}};
  std::vector<double> ranges, depths;
  for (int i = 0; i <= 40; ++i) {
    ranges.push_back(last * 1.01 * i / 40.0);
    const double share = i / 40.0;
    depths.push_back(kind == 2 ? bottom * (1.0 - 0.4 * share)
                               : bottom * (1.0 - 0.3 * std::exp(-40.0 * std::pow(share - 0.5, 2))));
  }
  if (kind == 2 || kind == 3 || kind == 4)
    run_case.environment.bottom.shape = BoundaryShape(
        ranges, depths,
        kind == 4 ? ShapeInterpolation::curvilinear : ShapeInterpolation::piecewise_linear);
  if (kind == 5) {
    for (std::size_t i = 0; i < ranges.size(); ++i) depths[i] = std::sin(2.0 * double(i));
    run_case.environment.surface.shape =
        BoundaryShape(ranges, depths, ShapeInterpolation::curvilinear);
  }
  run_case.frequency = draw(50.0, 500.0);
  run_case.source_depths = {draw(0.2, 0.6) * bottom};
  for (int j = 1; j <= 60; ++j) run_case.receivers.ranges.push_back(last * j / 60.0);
  for (int k = 1; k <= 40; ++k) run_case.receivers.depths.push_back(0.65 * bottom * k / 40.0);
  run_case.beams.lowest = -radians(draw(20.0, 50.0));
  run_case.beams.highest = radians(draw(20.0, 50.0));
  return run_case;
}

// Fields with interpolated rays are off by a fifth of what is wanted at most, at 95 % of the
// receivers. Their bound is hardly less than that of traced ones, and as good a bound: the truth is
// a fan eight times as dense. Each kind of sea once, with hats or Gaussians in turn; the deep check
// twice with both.
TEST(RaysBetween, AreThoseTraced) {
  const bool deep = support::deep();
  for (unsigned seed = 1; seed <= (deep ? 12U : 6U); ++seed)
    for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian}) {
      const bool its_turn = (kind == BeamKind::hat) == (seed % 2 == 0);
      if (!deep && !its_turn) continue;
      for (const FieldKind sum : {FieldKind::coherent, FieldKind::incoherent}) {
        PropagationCase run_case = random_sea(seed);
        run_case.beams.kind = kind;
        run_case.field = sum;
        const RayTracer tracer(run_case.environment, run_case.frequency);
        const auto field = [&](int beams, const FieldCheck& also) {
          return field_of_fan(run_case, tracer, run_case.source_depths[0],
                              even_fan(run_case.beams.lowest, run_case.beams.highest, beams), {},
                              FieldMethod::fast, also);
        };
        const FanField traced = field(1001, {.bound = true}),
                       some = field(1001, {.bound = true, .between = true});
        SCOPED_TRACE(testing::Message()
                     << "seed " << seed << " kind " << int(kind) << " sum " << int(sum));
        EXPECT_LT(level_difference_db(some.field, traced.field, 0.95), 0.2 * wanted_bound_db);
        const bool coherent = sum == FieldKind::coherent;
        EXPECT_GE(bound_db(some.field, some.bound, coherent, 0.5),
                  0.95 * bound_db(traced.field, traced.bound, coherent, 0.5));
        const auto truth = field(8001, {}).field;
        EXPECT_LE(level_difference_db(some.field, truth, 0.95),
                  bound_db(some.field, some.bound, coherent, 0.95));
        std::size_t beyond = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          const double error = coherent ? std::abs(some.field[i] - truth[i])
                                        : std::abs(std::norm(some.field[i]) - std::norm(truth[i]));
          beyond += error > some.bound[i] ? 1U : 0U;
        }
        EXPECT_LE(double(beyond), 0.05 * double(truth.size()));
      }
    }
}

// Whoever has which packet of rays: the same bits.
TEST(RaysBetween, AreTheSameForAnyNumberOfThreads) {
  for (const unsigned seed : {2U, 6U})
    for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian}) {
      PropagationCase run_case = random_sea(seed);
      run_case.beams.kind = kind;
      const RayTracer tracer(run_case.environment, run_case.frequency);
      const BeamFan fan = even_fan(run_case.beams.lowest, run_case.beams.highest, 3001);
      std::optional<FanField> first;
      for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const FanField now = field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {},
                                          FieldMethod::fast, {.bound = true, .between = true});
        if (!first) first = now;
        EXPECT_EQ(now.field, first->field) << threads;
        EXPECT_EQ(now.bound, first->bound) << threads;
        EXPECT_EQ(now.tube_share, first->tube_share) << threads;
      }
    }
}

/// Stratified water: lines, parabolas and smooth laws over a fluid bottom.
PropagationCase stratified(unsigned seed) {
  PropagationCase run_case = random_sea(6 * seed + seed % 2);  // spline, PCHIP
  const auto& water = run_case.environment.water;
  std::vector<double> z, c;
  for (int i = 0; i <= 12; ++i) {
    z.push_back(run_case.environment.bottom.depth * i / 10.0);
    c.push_back(water.at(z.back()).c);
  }
  if (seed % 4 == 2)
    run_case.environment.water = SoundSpeedProfile::table(z, c, Interpolation::c_linear);
  if (seed % 4 == 3)
    run_case.environment.water = SoundSpeedProfile::table(z, c, Interpolation::n2_linear);
  if (seed % 3 == 0) run_case.environment.absorption = Thorp{};
  run_case.receivers.depths.back() = run_case.environment.bottom.depth + 1e-9;  // by rounding
  run_case.receivers.depths.front() = 0.0;
  return run_case;
}

// The sum of all paths is what a fan of hats narrows to: as near to a fan as that says it is sure
// to, of either source, with a pattern, for all three sums, on the boundaries too. Each law of the
// water once, twice in the deep check.
TEST(PathField, IsWhatHatsNarrowTo) {
  for (unsigned seed = 1; seed <= (support::deep() ? 8U : 4U); ++seed)
    for (const FieldKind sum :
         {FieldKind::coherent, FieldKind::incoherent, FieldKind::semi_coherent})
      for (const bool line : {false, true}) {
        PropagationCase run_case = stratified(seed);
        run_case.field = sum;
        if (line) {
          run_case.beams.source = SourceKind::line;
          run_case.beams.pattern = SourcePattern{{-1.0, 0.0, 1.0}, {0.2, 1.0, 0.5}};
        }
        SCOPED_TRACE(testing::Message() << "seed " << seed << " sum " << int(sum) << ' ' << line);
        const double zs = run_case.source_depths[0];
        const auto paths = path_field(run_case, zs);
        ASSERT_TRUE(paths);
        EXPECT_EQ(paths->beams, 0U);
        EXPECT_LT(paths->error_db, 0.05);
        const RayTracer tracer(run_case.environment, run_case.frequency);
        const ConvergedField hats =
            converged_field(run_case, [&](const BeamFan& fan, const FieldCheck& also) {
              return field_of_fan(run_case, tracer, zs, fan, {}, FieldMethod::fast, also);
            });
        const double apart = level_difference_db(paths->field, hats.field, 0.95);
        EXPECT_LE(apart, std::min(hats.error_db, 0.5) + paths->error_db) << hats.beams;
        EXPECT_LT(level_difference_db(paths->field, hats.field, 0.5), 0.05) << hats.beams;
      }
}

// Not where their limit is another, there is none, or the water is no such guide.
TEST(PathField, IsChosenOnlyWhereItIsTheBeamsLimit) {
  const auto found = [](unsigned seed, auto&& change) {
    PropagationCase run_case = stratified(seed);
    change(run_case);
    return path_field(run_case, run_case.source_depths[0]).has_value();
  };
  EXPECT_TRUE(found(1, [](auto&) {}));
  EXPECT_TRUE(found(1, [](auto& c) { c.beams.kind = BeamKind::ray_centred_hat; }));
  EXPECT_FALSE(found(1, [](auto& c) { c.beams.kind = BeamKind::gaussian; }));
  EXPECT_FALSE(found(1, [](auto& c) { c.beams.elevations = {-0.1, 0.0, 0.1}; }));
  EXPECT_FALSE(found(1, [](auto& c) { c.beams.displacement = true; }));
  EXPECT_FALSE(found(1, [](auto& c) { c.box_depth = 0.9 * c.environment.bottom.depth; }));
  EXPECT_FALSE(found(1, [](auto& c) { c.receivers.ranges.front() = -100.0; }));
  EXPECT_FALSE(found(1, [](auto& c) { c.environment = random_sea(2).environment; }));
  EXPECT_FALSE(found(1, [](auto& c) {  // a kink of least speed at the source
    const double zs = c.source_depths[0], end = 2.0 * c.environment.bottom.depth;
    const double z[] = {0.0, zs, end}, v[] = {1520.0, 1490.0, 1520.0};
    c.environment.water = SoundSpeedProfile::table(z, v, Interpolation::c_linear);
  }));
  EXPECT_FALSE(found(1, [](auto& c) {  // more paths than beams
    c.environment.bottom.material = Rigid{};
    c.beams.lowest = -radians(89.0), c.beams.highest = radians(89.0);
    c.receivers.ranges.back() = 1e6;
  }));
}

}  // namespace
}  // namespace asdic::detail
