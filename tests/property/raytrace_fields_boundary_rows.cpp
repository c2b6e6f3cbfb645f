#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "raytrace/beams/boundary_rows.h"
#include "raytrace/beams/convergence.h"
#include "raytrace/beams/field_run.h"

// Fields at receivers on the surface and on the bottom (boundary_rows.h).
namespace asdic {
namespace {

/// 100 to 1000 m of water of c-linear layers, flat, sloped or swelling, over a fluid bottom, and
/// receivers on the bottom (of a slope: where its depth at a range is a row).
PropagationCase on_the_bottom(unsigned seed, bool shaped) {
  std::mt19937 random(seed);
  const auto draw = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  PropagationCase run_case;
  const double bottom = draw(100.0, 1000.0), slope = shaped ? draw(-0.05, 0.05) : 0.0;
  std::vector<double> depth = {0.0}, speed = {draw(1480.0, 1530.0)};
  while (depth.back() < 2.0 * bottom) {
    depth.push_back(depth.back() + bottom * draw(0.1, 0.5));
    speed.push_back(speed.back() + draw(-0.1, 0.1) * std::min(100.0, bottom * 0.1));
  }
  run_case.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  run_case.environment.bottom = {
      .depth = bottom,
      .material = FluidHalfSpace{.speed = draw(1550.0, 1800.0), .density = 1800.0}};
  const double last = 10.0 * bottom;
  if (shaped)
    run_case.environment.bottom.shape =
        BoundaryShape(std::vector{0.0, last}, std::vector{bottom, bottom + slope * last},
                      ShapeInterpolation::piecewise_linear);
  run_case.frequency = draw(100.0, 1000.0);
  run_case.source_depths = {draw(0.1, 0.9) * bottom};
  for (int j = 1; j <= 40; ++j) {
    run_case.receivers.ranges.push_back(last * j / 41.0);
    if (shaped || j == 1)
      run_case.receivers.depths.push_back(
          run_case.environment.bottom.depth_at(run_case.receivers.ranges.back()));
  }
  std::sort(run_case.receivers.depths.begin(), run_case.receivers.depths.end());
  run_case.beams.lowest = -radians(draw(20.0, 60.0));
  run_case.beams.highest = radians(draw(20.0, 60.0));
  return run_case;
}

// A reflection between two neighbours tears no tube for receivers on the boundary. The bound is one
// there: at 95 % of them and, but for those beside the fan's edges and caustics, one by one,
// against fans four times as dense; and it is of use: with 2001 beams half of the receivers are
// sure to wanted_bound_db, where a torn tube a reflection had left none of them sure to any number.
TEST(BoundAtBoundaries, HoldsAndIsOfUse) {
  for (unsigned seed = 1; seed <= 6; ++seed)
    for (const bool shaped : {false, true})
      for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian})
        for (const FieldKind sum : {FieldKind::coherent, FieldKind::incoherent}) {
          PropagationCase run_case = on_the_bottom(seed, shaped);
          run_case.beams.kind = kind;
          run_case.field = sum;
          const RayTracer tracer(run_case.environment, run_case.frequency);
          const BoundaryRows walls(run_case.environment, run_case.frequency, run_case.receivers);
          const std::size_t columns = run_case.receivers.ranges.size();
          const auto fan = [&](int beams) {
            return even_fan(run_case.beams.lowest, run_case.beams.highest, beams);
          };
          const bool coherent = sum == FieldKind::coherent;
          const double zs = run_case.source_depths[0];
          const FanField f =
              field_of_fan(run_case, tracer, zs, fan(2001), {}, FieldMethod::fast, {.bound = true});
          const auto truth = field_of_fan(run_case, tracer, zs, fan(8001)).field;
          std::vector<std::complex<double>> field, dense;
          std::vector<double> bound;
          double beyond = 0.0;
          for (std::size_t j = 0; j < columns; ++j) {
            const std::int32_t row = walls.row(BoundaryKind::bottom, j);
            ASSERT_GE(row, 0);
            const std::size_t i = static_cast<std::size_t>(row) * columns + j;
            field.push_back(f.field[i]), dense.push_back(truth[i]), bound.push_back(f.bound[i]);
            const double error = coherent ? std::abs(f.field[i] - truth[i])
                                          : std::abs(std::norm(f.field[i]) - std::norm(truth[i]));
            beyond += error > f.bound[i];
          }
          SCOPED_TRACE(testing::Message() << "seed " << seed << " shaped " << shaped << " kind "
                                          << int(kind) << " sum " << int(sum));
          const double error_db = level_difference_db(field, dense, 0.95);
          const double told = bound_db(field, bound, coherent, 0.95);
          EXPECT_LE(error_db, told);
          EXPECT_LE(beyond / double(columns), 0.05);
          EXPECT_LE(bound_db(field, bound, coherent, 0.5), 0.5);
        }
}

// So the rule finds its number of beams for receivers on the bottom alone.
TEST(BoundAtBoundaries, LetsTheRuleEnd) {
  const PropagationCase run_case = on_the_bottom(3, false);
  const PropagationResult result = run_field(run_case);
  EXPECT_TRUE(result.beam_error_bounded);
  EXPECT_LE(result.beam_error_db, wanted_bound_db);
  EXPECT_TRUE(result.notes.empty());
  EXPECT_LT(result.beams, 8000U);
}

}  // namespace
}  // namespace asdic
