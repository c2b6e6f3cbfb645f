#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "raytrace/beams/boundary_rows.h"
#include "raytrace/beams/convergence.h"
#include "raytrace/runs/field_run.h"

// Fields at receivers on the surface and on the bottom (boundary_rows.h).
namespace asdic::detail {
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
          const BoundaryRows walls(run_case.environment, run_case.frequency, run_case.receivers,
                                   sum == FieldKind::coherent);
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
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const ConvergedField result =
      converged_field(run_case, [&](const BeamFan& fan, const FieldCheck& also) {
        return field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {}, FieldMethod::fast,
                            also);
      });
  EXPECT_TRUE(result.bounded);
  EXPECT_LE(result.error_db, wanted_bound_db);
  EXPECT_TRUE(result.note.empty());
  EXPECT_LT(result.beams, 8000U);
}

/// Iso-speed water, 500 m deep, and a fan that meets the receivers at 1 km straight and by one
/// reflection at the bottom.
PropagationCase above_the_bottom(BeamKind kind, std::vector<double> depths) {
  PropagationCase run_case;
  run_case.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  run_case.environment.bottom = {.depth = 500.0,
                                 .material = FluidHalfSpace{.speed = 1700.0, .density = 1800.0}};
  run_case.frequency = 200.0;
  run_case.source_depths = {300.0};
  run_case.receivers = {.depths = std::move(depths), .ranges = {1000.0}};
  run_case.beams.lowest = radians(-40.0);
  run_case.beams.highest = radians(-2.0);
  run_case.beams.kind = kind;
  return run_case;
}

std::vector<std::complex<double>> field_of(const PropagationCase& run_case, int beams) {
  const RayTracer tracer(run_case.environment, run_case.frequency);
  return field_of_fan(run_case, tracer, run_case.source_depths[0],
                      even_fan(run_case.beams.lowest, run_case.beams.highest, beams))
      .field;
}

/// The direct path and its image under the bottom, with R at the image's angle.
double exact_db(const PropagationCase& run_case, double depth) {
  const double range = run_case.receivers.ranges[0], k = 2.0 * pi * run_case.frequency / 1500.0;
  const double down = depth - 300.0, image = 2.0 * 500.0 - depth - 300.0;
  const std::complex<double> reflection = reflection_coefficient(
      run_case.environment.bottom.material, std::atan(image / range), {.speed = 1500.0});
  const double a = std::hypot(range, down), b = std::hypot(range, image);
  return 20.0 * std::log10(std::abs(std::polar(1.0 / a, -k * a) +
                                    reflection * std::polar(1.0 / b, -k * b)));
}

// Beams as narrow as their tubes: on the bottom and half a metre above, a dozen tubes, the field is
// the sum of both paths. 0.01 complex is what simple Gaussians are right to in free space: 0.1 dB.
TEST(FieldsAtBoundaries, OfNarrowBeamsAreTheLimitFromInside) {
  for (const BeamKind kind :
       {BeamKind::hat, BeamKind::ray_centred_hat, BeamKind::simple_gaussian}) {
    const PropagationCase run_case = above_the_bottom(kind, {499.5, 500.0});
    const auto field = field_of(run_case, 20'001);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(20.0 * std::log10(std::abs(field[k])),
                  exact_db(run_case, run_case.receivers.depths[k]), 0.15)
          << int(kind) << ' ' << k;
  }
}

// Gaussians of least width σ lose what their rays have left at the bottom: Φ(d·cos θ/σ) of both
// waves is there at a distance d, half of them (6.02 dB) just above it. On the bottom itself the
// pairs bring the other half. (0.1 dB: the bell's own bias, 0.3 %, and its cut at 4σ; R is the same
// at all angles, else its bell would mix some.)
TEST(FieldsAtBoundaries, OfGaussiansAreWholeOnThemAndHalfJustInside) {
  for (const BeamKind kind : {BeamKind::gaussian, BeamKind::ray_centred_gaussian}) {
    PropagationCase run_case = above_the_bottom(kind, {499.99, 500.0});
    run_case.environment.bottom.material = FluidHalfSpace{.speed = 1500.0, .density = 2500.0};
    run_case.frequency = 1000.0;
    const auto field = field_of(run_case, 16'001);
    const double inside = 20.0 * std::log10(std::abs(field[0]));
    EXPECT_NEAR(inside - exact_db(run_case, 499.99), 20.0 * std::log10(0.5), 0.1) << int(kind);
    EXPECT_NEAR(20.0 * std::log10(std::abs(field[1])), exact_db(run_case, 500.0), 0.1) << int(kind);
  }
}

// Cerveny's beams go on beyond the boundary, and their images come back: both are smooth there. A
// millimetre is 1e-3 of phase. Beam and image in the surface cancel on it but for rounding (a third
// image, in the bottom, has none in the surface).
TEST(FieldsAtBoundaries, OfCervenyBeamsAreContinuous) {
  for (const BeamKind kind : {BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred})
    for (const int images : {1, 2, 3}) {
      PropagationCase run_case = above_the_bottom(kind, {0.0, 0.001, 499.999, 500.0});
      run_case.beams.lowest = radians(-40.0), run_case.beams.highest = radians(40.0);
      run_case.beams.cerveny = CervenyBeams{.images = images};
      const auto field = field_of(run_case, 401);
      const double scale = std::abs(field[3]);
      EXPECT_LT(std::abs(field[0] - field[1]), 3e-3 * scale) << int(kind) << ' ' << images;
      EXPECT_LT(std::abs(field[2] - field[3]), 3e-3 * scale) << int(kind) << ' ' << images;
      if (images == 2) {
        EXPECT_LT(std::abs(field[0]), 1e-6 * scale) << int(kind) << ' ' << images;
      }
    }
}

// A pressure-release surface leaves nothing of any geometric kind: what is left is rounding.
TEST(FieldsAtBoundaries, AreNothingAtAVacuum) {
  for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian, BeamKind::ray_centred_hat,
                              BeamKind::ray_centred_gaussian, BeamKind::simple_gaussian}) {
    PropagationCase run_case = above_the_bottom(kind, {0.0, 250.0});
    run_case.beams.lowest = radians(-60.0), run_case.beams.highest = radians(60.0);
    const auto field = field_of(run_case, 2001);
    EXPECT_LT(std::abs(field[0]), 1e-5 * std::abs(field[1])) << int(kind);
  }
}

}  // namespace
}  // namespace asdic::detail
