#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "raytrace/beams/convergence.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/propagation.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/runs/field_run.h"
#include "raytrace/tracing/marching_eigenrays.h"

// Fields of sources and at receivers where rays have something special to them: kinks of the sound
// speed, boundaries, nodes of boundaries.
namespace asdic::detail {
namespace {

// Over a floor that rises from 200 m to 100 m at 5 km, 120 m deep 4 km away: the run says how many.
TEST(FieldsOutsideOfTheWater, AreNoneAndTheRunSaysSo) {
  PropagationCase c;
  c.frequency = 200.0;
  c.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  c.environment.bottom = {.depth = 200.0, .material = FluidHalfSpace{}};
  c.source_depths = {50.0};
  c.receivers = {.depths = {0.0, 60.0, 150.0, 200.0}, .ranges = {500.0, 4000.0}};
  const auto told = [](const PropagationResult& result) {
    std::string all;
    for (const std::string& note : result.notes) all += note + '\n';
    return all;
  };
  EXPECT_EQ(told(run(c)).find("below the bottom"), std::string::npos);
  const double range[] = {0.0, 5000.0}, depth[] = {200.0, 100.0};
  c.environment.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  const PropagationResult result = run(c);
  EXPECT_NE(told(result).find("of 8 receivers 3 lie below the bottom and 0 above the surface"),
            std::string::npos)
      << told(result);
  EXPECT_LT(std::abs(result.field[5]), 1e-3F * std::abs(result.field[3]));
  EXPECT_GT(std::abs(result.field[3]), 0.0F);
  c.receivers = {.depths = {-1.0, 150.0}, .ranges = {500.0, 4000.0}, .irregular = true};
  c.task = Task::arrivals;
  EXPECT_NE(told(run(c)).find("of 2 receivers 1 lie below the bottom and 1 above"),
            std::string::npos);
}

/// 200 m of water over a fluid, the sound speed least at 50 m, with a kink.
PropagationCase kinked_duct() {
  PropagationCase run_case;
  run_case.environment.water = SoundSpeedProfile::table(
      std::vector{0.0, 50.0, 200.0}, std::vector{1500.0, 1495.0, 1505.0}, Interpolation::c_linear);
  run_case.environment.bottom = {.depth = 200.0,
                                 .material = FluidHalfSpace{.speed = 1600.0, .density = 1800.0}};
  run_case.frequency = 250.0;
  run_case.source_depths = {50.0};
  for (int j = 1; j <= 25; ++j) run_case.receivers.ranges.push_back(400.0 * j);
  for (int k = 1; k <= 9; ++k) run_case.receivers.depths.push_back(20.0 * k);
  run_case.receivers.depths.push_back(50.0);
  std::sort(run_case.receivers.depths.begin(), run_case.receivers.depths.end());
  run_case.beams.lowest = radians(-30.0);
  run_case.beams.highest = radians(30.0);
  return run_case;
}

// Rays launched nearly level from the kink run in ever shorter arcs without end, and no number of
// beams is enough for receivers at its depth (level_rays.h). The rule leaves these alone; all other
// rows are as sure as it says, against an even fan as dense as any it may use.
TEST(FieldsAtSpecialPlaces, OfASourceOnAKinkOfLeastSpeed) {
  const PropagationCase run_case = kinked_duct();
  const PropagationResult own = run_field(run_case);
  EXPECT_LE(own.beams, static_cast<std::size_t>(most_beams));
  EXPECT_LE(own.beam_error_db, wanted_bound_db);
  ASSERT_EQ(own.notes.size(), 1U);
  EXPECT_NE(own.notes[0].find("kink"), std::string::npos);
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const auto dense =
      field_of_fan(run_case, tracer, 50.0,
                   even_fan(run_case.beams.lowest, run_case.beams.highest, most_beams))
          .field;
  const std::size_t columns = run_case.receivers.ranges.size();
  std::vector<std::complex<double>> a, b;
  for (std::size_t i = 0; i < dense.size(); ++i)
    if (run_case.receivers.depths[i / columns] != 50.0)
      a.emplace_back(own.field[i]), b.push_back(dense[i]);
  EXPECT_LT(level_difference_db(a, b, 0.95), 2.0 * wanted_bound_db);  // each is sure to one
}

// ε and h of the header's formula, h = cα²/(2g) with the lesser gradient, 10/150 1/s; none beside
// the kink, at a maximum, or where the speed is smooth.
TEST(LevelRays, AreThoseOfAKinkOfLeastSpeed) {
  const Environment ocean = kinked_duct().environment;
  const LevelRays level = level_rays(ocean, 250.0, 0.0, 50.0);
  EXPECT_NEAR(level.height, 1495.0 / 250.0 / 1000.0, 1e-12);
  EXPECT_NEAR(1495.0 * level.angle * level.angle / (2.0 * 10.0 / 150.0), level.height, 1e-9);
  EXPECT_EQ(level_rays(ocean, 250.0, 0.0, 51.0).angle, 0.0);
  Environment other = ocean;
  other.water = SoundSpeedProfile::table(
      std::vector{0.0, 50.0, 200.0}, std::vector{1490.0, 1495.0, 1480.0}, Interpolation::c_linear);
  EXPECT_EQ(level_rays(other, 250.0, 0.0, 50.0).angle, 0.0);
  other.water = SoundSpeedProfile::munk();
  EXPECT_EQ(level_rays(other, 250.0, 0.0, 1300.0).angle, 0.0);
}

// A pressure-release surface takes back all that a source on it sends; said without a search.
TEST(FieldsAtSpecialPlaces, OfASourceOnTheSurface) {
  PropagationCase run_case = kinked_duct();
  run_case.source_depths = {0.0};
  const PropagationResult nothing = run_field(run_case);
  EXPECT_EQ(nothing.beams, 0U);
  EXPECT_EQ(nothing.beam_error_db, 0.0);
  for (const auto& p : nothing.field) EXPECT_EQ(std::abs(p), 0.0F);
  ASSERT_EQ(nothing.notes.size(), 1U);
  EXPECT_NE(nothing.notes[0].find("vacuum"), std::string::npos);
}

// No tube is divided below what was asked for, whatever its share.
TEST(GradedFans, HaveNoTubesFinerThanAsked) {
  const BeamFan even = even_fan(-1.0, 1.0, 9);
  const BeamFan fan =
      graded_fan(even, std::vector<double>(8, 1.0), 1000, {.width = 0.06, .level = 0.11});
  double least = 1.0, least_level = 1.0;
  for (std::size_t i = 0; i + 1 < fan.elevation.size(); ++i) {
    const bool level = fan.elevation[i] < 0.11 && fan.elevation[i + 1] > -0.11;
    (level ? least_level : least) =
        std::min(level ? least_level : least, fan.elevation[i + 1] - fan.elevation[i]);
  }
  EXPECT_GE(least, 0.06);
  EXPECT_GE(least_level, 0.11);
}

/// Iso-speed water over a bottom of two slopes, and a receiver on the node between them.
PropagationCase node_between_slopes() {
  PropagationCase run_case;
  run_case.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  run_case.environment.bottom = {
      .depth = 200.0,
      .material = FluidHalfSpace{.speed = 1700.0, .density = 1800.0},
      .shape = BoundaryShape(std::vector{0.0, 2000.0, 5000.0}, std::vector{200.0, 180.0, 100.0},
                             ShapeInterpolation::piecewise_linear)};
  run_case.frequency = 500.0;
  run_case.source_depths = {50.0};
  run_case.receivers = {.depths = {180.0}, .ranges = {2000.0}};
  run_case.beams.lowest = radians(-60.0);
  run_case.beams.highest = radians(60.0);
  return run_case;
}

Arrivals arrivals_at_the_receiver(const PropagationCase& run_case, double faintest = 1e-4) {
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const std::vector<ReceiverPoint> receiver = {
      {run_case.receivers.ranges[0], run_case.receivers.depths[0]}};
  return marching_eigenrays(tracer, 0.0, run_case.source_depths[0], receiver,
                            {.lowest = run_case.beams.lowest,
                             .highest = run_case.beams.highest,
                             .max_surface_bounces = 2048,
                             .max_bottom_bounces = 2048,
                             .max_turns = 4096,
                             .faintest = faintest})[0];
}

// What arrives at the bottom leaves it at once: paths come in pairs of equal delay, one reflection
// apart. (Of none too faint to be followed past its last reflection.)
TEST(ArrivalsAtSpecialPlaces, AtANodeOfTheBottomComeInPairs) {
  const Arrivals all = arrivals_at_the_receiver(node_between_slopes(), 0.0);
  EXPECT_GE(all.size(), 24U);
  for (const Arrival& a : all)
    EXPECT_EQ(std::count_if(all.begin(), all.end(),
                            [&](const Arrival& b) {
                              return std::abs(a.delay - b.delay) < 1e-8 &&
                                     a.surface_bounces == b.surface_bounces &&
                                     std::abs(a.bottom_bounces - b.bottom_bounces) == 1;
                            }),
              1)
        << a.delay << ' ' << a.bottom_bounces;
}

// The sum of hats at a receiver on a boundary is the sum of its arrivals (0.2 dB: rays 3·10⁻⁵ rad
// apart, no caustic near), and nothing at the surface. On a node each arrival is reflected by one
// facet or the other, whose slopes differ by 1 degree: below the critical angle, 28 degrees, R
// turns by some 180/28 times that, 0.1 rad, which is 10 % of the field or 0.9 dB.
TEST(FieldsAtSpecialPlaces, OnBoundariesAreTheSumsOfArrivals) {
  PropagationCase run_case = node_between_slopes();
  const auto tl_of_field = [&] {
    return -20.0 * std::log10(static_cast<double>(std::abs(run_field(run_case).field[0])));
  };
  const auto tl_of_arrivals = [&] {
    std::complex<double> sum = 0.0;
    for (const Arrival& a : arrivals_at_the_receiver(run_case))
      sum += a.amplitude * std::polar(1.0, -2.0 * pi * run_case.frequency * a.delay);
    return -20.0 * std::log10(std::abs(sum));
  };
  EXPECT_NEAR(tl_of_field(), tl_of_arrivals(), 0.9);
  run_case.environment.bottom.shape.reset();
  for (const double range : {1000.0, 2000.0, 3000.0}) {
    run_case.receivers = {.depths = {200.0}, .ranges = {range}};
    EXPECT_NEAR(tl_of_field(), tl_of_arrivals(), 0.2) << range;
    run_case.receivers.depths = {0.0};
    EXPECT_GT(tl_of_field(), 120.0) << range;
  }
}

// A duct whose axis is a kink, over a slope, source and receiver on the axis: no end of paths, and
// of rays between any two of them. The search ends, with the paths that leave the axis by more than
// a quarter of a wavelength in pairs up and down, and the level one; and heeds its watch.
TEST(ArrivalsAtSpecialPlaces, AlongAKinkOfLeastSpeedHaveAnEnd) {
  PropagationCase run_case = node_between_slopes();
  run_case.environment.water = SoundSpeedProfile::table(
      std::vector{0.0, 80.0, 200.0}, std::vector{1500.0, 1480.0, 1500.0}, Interpolation::c_linear);
  run_case.source_depths = {80.0};
  run_case.receivers.depths = {80.0};
  const LevelRays level = level_paths(run_case.environment, run_case.frequency, 0.0, 80.0);
  const Arrivals all = arrivals_at_the_receiver(run_case);
  EXPECT_LT(all.size(), 100U);
  EXPECT_EQ(std::count_if(all.begin(), all.end(),
                          [](const Arrival& a) { return a.launch_elevation == 0.0; }),
            1);
  // R = n·cα/g₁ + n·cα/g₂ for n whole cycles: about R/(cε(1/g₁ + 1/g₂)) of them, for each side
  const double cycles = 2000.0 / (2.0 * 1480.0 * level.angle * (80.0 / 20.0 + 120.0 / 20.0));
  const auto trapped = std::count_if(all.begin(), all.end(), [](const Arrival& a) {
    return a.surface_bounces + a.bottom_bounces == 0 && a.launch_elevation != 0.0;
  });
  EXPECT_GE(trapped, static_cast<int>(2.0 * cycles) - 4);
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const std::vector<ReceiverPoint> receiver = {{2000.0, 80.0}};
  std::atomic<int> asked = 0;
  SearchWatch watch{.progress = [&](double) { return ++asked < 3; }};
  (void)marching_eigenrays(tracer, 0.0, 80.0, receiver, {}, &watch);
  EXPECT_TRUE(watch.stopped);
  EXPECT_LT(asked, 64);
}

// Both solvers find one and the same finite set from a kinked axis, at it, within λ/4 of it and
// away from it, and a run says once which path stands for others: of n whole cycles R = 2cnα(1/g₁ +
// 1/g₂).
TEST(ArrivalsAtSpecialPlaces, FromAKinkOfLeastSpeedAreTheSameByBothSolvers) {
  PropagationCase run_case = kinked_duct();
  run_case.receivers = {.depths = {50.0, 50.5, 100.0}, .ranges = {2000.0, 10000.0}};
  for (const double frequency : {250.0, 3000.0}) {
    run_case.frequency = frequency;
    run_case.receivers.depths[1] = 50.0 + 100.0 / frequency;
    const PropagationResult layered = run_arrivals(run_case, {}, {.weakest_db = 300.0});
    ASSERT_EQ(layered.notes.size(), 1U);
    EXPECT_NE(layered.notes[0].find("kink"), std::string::npos);
    const RayTracer tracer(run_case.environment, frequency);
    const auto marched = marching_eigenrays(tracer, 0.0, 50.0, points_of(run_case.receivers),
                                            {.lowest = run_case.beams.lowest,
                                             .highest = run_case.beams.highest,
                                             .max_surface_bounces = 2048,
                                             .max_bottom_bounces = 2048,
                                             .max_turns = 4096,
                                             .faintest = 1e-3});
    const LevelRays level = level_paths(run_case.environment, frequency, 0.0, 50.0);
    for (std::size_t i = 0; i < marched.size(); ++i) {
      const auto sane = [](const Arrival& a) { return std::abs(a.reflection) > 2e-3; };
      Arrivals a, b;
      std::copy_if(layered.arrivals[i].begin(), layered.arrivals[i].end(), std::back_inserter(a),
                   sane);
      std::copy_if(marched[i].begin(), marched[i].end(), std::back_inserter(b), sane);
      ASSERT_EQ(a.size(), b.size()) << frequency << ' ' << i;
      for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k].delay, b[k].delay, 1e-8);
      const auto cycles =
          static_cast<std::ptrdiff_t>(run_case.receivers.ranges[i % 2] /
                                      (2.0 * 1495.0 * level.angle * (50.0 / 5.0 + 150.0 / 10.0)));
      if (i >= 4) continue;  // away from the axis
      EXPECT_LE(
          std::count_if(a.begin(), a.end(), [](const Arrival& x) { return x.bounces.empty(); }),
          4 * cycles + 5)  // up and down, of whole cycles and half a cycle more; the level one
          << frequency << ' ' << i;
    }
  }
}

// A source on the surface: the paths are there, and a note that their sum is nothing.
TEST(ArrivalsAtSpecialPlaces, OfASourceOnTheSurfaceCancelAndSaySo) {
  PropagationCase run_case = kinked_duct();
  run_case.source_depths = {0.0};
  run_case.receivers = {.depths = {100.0}, .ranges = {5000.0}};
  const PropagationResult result = run_arrivals(run_case);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("vacuum"), std::string::npos);
  std::complex<double> sum = 0.0;
  double strongest = 0.0;
  for (const Arrival& a : result.arrivals[0]) {
    sum += a.amplitude * std::polar(1.0, -2.0 * pi * run_case.frequency * a.delay);
    strongest = std::max(strongest, std::abs(a.amplitude));
  }
  EXPECT_GT(result.arrivals[0].size(), 4U);
  EXPECT_LT(std::abs(sum), 1e-5 * strongest);
}

}  // namespace
}  // namespace asdic::detail
