#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "io/compare/arrivals.h"
#include "io/compare/fields.h"
#include "io/compare/rays.h"

// Comparison of two fields, arrival lists or ray sets that differ in a way that is known.

namespace asdic::detail::compare {
namespace {

using bellhop::ArrivalRow;
using bellhop::ArrivalsFile;
using bellhop::RayFile;
using bellhop::ShadeFile;

constexpr double pi = 3.14159265358979323846;

TEST(Quantile, LiesOnStraightLinesBetweenTheSortedValues) {
  const std::vector<double> x = {1.0, 2.0, 4.0, 8.0};
  EXPECT_DOUBLE_EQ(quantile(x, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(x, 0.5), 3.0);   // half way between 2 and 4
  EXPECT_DOUBLE_EQ(quantile(x, 0.95), 7.4);  // 0.85 of the way from 4 to 8
  EXPECT_DOUBLE_EQ(quantile(x, 1.0), 8.0);
}

TEST(SpreadOf, TakesMagnitudesButForTheMean) {
  const Spread spread = spread_of({-3.0, 1.0, 2.0});
  EXPECT_EQ(spread.count, 3U);
  EXPECT_DOUBLE_EQ(spread.mean, 0.0);
  EXPECT_DOUBLE_EQ(spread.median, 2.0);
  EXPECT_DOUBLE_EQ(spread.max, 3.0);
  EXPECT_EQ(spread_of({}).count, 0U);
}

/// A point source in free space, exp(−ikr)/r, at two depths and a hundred ranges.
ShadeFile free_space() {
  ShadeFile file{.frequency = 100.0, .source_depths = {50.0}, .receiver_depths = {50.0, 90.0}};
  for (int i = 1; i <= 100; ++i) file.receiver_ranges.push_back(100.0 * i);
  for (const double z : file.receiver_depths)
    for (const double r : file.receiver_ranges) {
      const double slant = std::hypot(r, z - 50.0);
      file.pressure.push_back(std::polar(1.0f / float(slant), float(-2 * pi * slant / 15.0)));
    }
  return file;
}

TEST(CompareFields, AFieldIsItself) {
  const FieldDifference d = compare_fields(free_space(), free_space());
  EXPECT_EQ(d.cells, 200U);
  EXPECT_EQ(d.compared, 200U);
  EXPECT_EQ(d.tl_db.max, 0.0);
  EXPECT_EQ(d.relative_error, 0.0);
  EXPECT_EQ(d.within_pct.front(), 100.0);
  EXPECT_NEAR(d.complex_correlation, 1.0, 1e-15);
}

// A field twice as loud and 30° ahead: ΔTL = −20 log 2 dB, error |2 e^{iπ/6} − 1|. The pressures
// are float32, whose grain of 6e-8 allows 1e-5 in each figure.
TEST(CompareFields, AFactorIsToldAsLevelPhaseAndError) {
  const ShadeFile b = free_space();
  ShadeFile a = b;
  const std::complex<double> factor = std::polar(2.0, pi / 6.0);
  for (auto& p : a.pressure) p = std::complex<float>(std::complex<double>(p) * factor);
  const FieldDifference d = compare_fields(a, b);
  const double db = 20.0 * std::log10(2.0);
  EXPECT_NEAR(d.tl_db.mean, -db, 1e-5);
  EXPECT_NEAR(d.tl_db.median, db, 1e-5);
  EXPECT_NEAR(d.tl_db.max, db, 1e-5);
  EXPECT_NEAR(d.level_db, db, 1e-5);
  EXPECT_NEAR(d.mean_phase_deg, 30.0, 1e-5);
  EXPECT_NEAR(d.phase_deg.p95, 30.0, 1e-4);
  EXPECT_NEAR(d.relative_error, std::abs(factor - 1.0), 1e-5);
  EXPECT_NEAR(d.complex_correlation, 1.0, 1e-6);
  EXPECT_NEAR(d.tl_correlation, 1.0, 1e-6);
  EXPECT_EQ(d.within_pct[4], 0.0);
}

TEST(CompareFields, SilenceAndNonsenseAreCountedApart) {
  const ShadeFile b = free_space();
  ShadeFile a = b;
  a.pressure[0] = 0.0f;                                     // nothing: one-sided
  a.pressure[1] = std::numeric_limits<float>::quiet_NaN();  // not a number
  a.pressure[2] = std::complex<float>(1e-7f, 0.0f);         // 140 dB: below the floor
  const FieldDifference d = compare_fields(a, b);
  EXPECT_EQ(d.compared, 197U);
  EXPECT_EQ(d.not_finite, 1U);
  EXPECT_NEAR(d.one_sided_pct, 100.0 * 2 / 199, 1e-12);
  EXPECT_EQ(d.tl_db.max, 0.0);
}

TEST(CompareFields, AFinerGridIsTakenWhereTheCoarseOneIs) {
  const ShadeFile a = free_space();
  ShadeFile b = a;
  b.receiver_depths = {90.0};
  b.receiver_ranges = {500.0, 10000.0};
  b.pressure = {a.pressure[104], a.pressure[199]};
  EXPECT_THROW(static_cast<void>(compare_fields(a, b)), InputError);
  const FieldDifference d = compare_fields(a, b, {.resample = true});
  EXPECT_EQ(d.compared, 2U);
  EXPECT_EQ(d.tl_db.max, 0.0);
  b.receiver_ranges[0] = 505.0;
  try {
    static_cast<void>(compare_fields(a, b, {.resample = true}));
    ADD_FAILURE() << "a range that A has not was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().where, "grid: receiver ranges");
    EXPECT_NE(error.fault().got.find("505"), std::string::npos) << error.what();
  }
}

ArrivalsFile one_receiver(std::vector<ArrivalRow> rows) {
  return {.frequency = 1000.0,
          .source_depths = {10.0},
          .receiver_depths = {20.0},
          .receiver_ranges = {5000.0},
          .arrivals = {std::move(rows)}};
}

// Two beams of one path, 5 µs apart at 1 kHz (a phase of 1.8°): amplitudes 3 and 1 in phase but for
// that, the delay where the weight is.
TEST(JoinBeams, AddsPressuresAndAveragesByAmplitude) {
  const std::vector<ArrivalRow> rows = {
      {.amplitude = 3e-4, .delay = 2.0, .launch_angle_deg = 4.0, .surface_bounces = 1},
      {.amplitude = 1e-4, .delay = 2.000005, .launch_angle_deg = 4.4, .surface_bounces = 1}};
  const auto paths = join_beams(rows, 1000.0, {});
  ASSERT_EQ(paths.size(), 1U);
  const double phase = 2 * pi * 5e-3;
  EXPECT_NEAR(paths[0].amplitude, 1e-4 * std::abs(3.0 + std::polar(1.0, -phase)), 1e-15);
  EXPECT_NEAR(paths[0].delay, 2.00000125, 1e-13);
  EXPECT_NEAR(paths[0].launch_angle_deg, 4.1, 1e-12);
  EXPECT_EQ(paths[0].surface_bounces, 1);
}

TEST(JoinBeams, KeepsPathsApartThatDifferInBouncesDelayOrAngle) {
  const ArrivalRow row{.amplitude = 1e-4, .delay = 2.0, .launch_angle_deg = 4.0};
  ArrivalRow bounced = row, late = row, steep = row;
  bounced.bottom_bounces = 1;
  late.delay += 25e-6;
  steep.launch_angle_deg += 1.5;
  for (const ArrivalRow& other : {bounced, late, steep})
    EXPECT_EQ(join_beams({row, other}, 1000.0, {}).size(), 2U);
  EXPECT_EQ(join_beams({row, row}, 1000.0, {.join_delay = 0.0}).size(), 2U);
}

TEST(CompareArrivals, DifferencesOfAPairAreThose) {
  const ArrivalRow b{.amplitude = 1e-4,
                     .phase_deg = 170.0,
                     .delay = 3.0,
                     .launch_angle_deg = 5.0,
                     .arrival_angle_deg = -5.0};
  ArrivalRow a = b;
  a.amplitude = 2e-4;
  a.phase_deg = -170.0;  // 20° further
  a.delay += 3e-6;
  a.arrival_angle_deg += 0.01;
  const ArrivalDifference d = compare_arrivals(one_receiver({a}), one_receiver({b}));
  EXPECT_EQ(d.matched, 1U);
  EXPECT_NEAR(d.amplitude_db.mean, 20.0 * std::log10(2.0), 1e-12);
  EXPECT_NEAR(d.phase_deg.mean, 20.0, 1e-10);
  EXPECT_NEAR(d.delay_us.mean, 3.0, 1e-8);
  EXPECT_NEAR(d.arrival_deg.mean, 0.01, 1e-12);
  EXPECT_EQ(d.launch_deg.max, 0.0);
  EXPECT_NEAR(d.sum_db.mean, -20.0 * std::log10(2.0), 1e-12);  // as TL: louder is less
}

// B has a strong path, one 10 dB down that A misses, one 30 dB down that A has, and one 50 dB down
// that does not count.
TEST(CompareArrivals, MissedPathsAreToldByCountEnergyAndName) {
  const auto row = [](double db, int bounces) {
    return ArrivalRow{.amplitude = 1e-3 * std::pow(10.0, db / 20.0),
                      .delay = 2.0 + bounces,
                      .bottom_bounces = bounces};
  };
  const ArrivalDifference d =
      compare_arrivals(one_receiver({row(0, 0), row(-30, 2), row(-12, 7)}),
                       one_receiver({row(0, 0), row(-10, 1), row(-30, 2), row(-50, 3)}));
  EXPECT_EQ(d.paths_b, 3U);
  EXPECT_EQ(d.paths_a, 3U);
  EXPECT_EQ(d.matched, 2U);
  EXPECT_EQ(d.strong_b, 2U);
  EXPECT_EQ(d.strong_matched, 1U);
  EXPECT_NEAR(d.energy_matched_pct, 100.0 * 1.001 / 1.101, 1e-9);
  ASSERT_EQ(d.missed.size(), 1U);
  EXPECT_EQ(d.missed[0].path.bottom_bounces, 1);
  EXPECT_NEAR(d.missed[0].level_db, -10.0, 1e-9);
}

// Absorption is in the imaginary part of the delay: exp(ω Im τ).
TEST(CompareArrivals, AbsorptionCountsInTheAmplitude) {
  ArrivalRow b{.amplitude = 1e-3, .delay = 2.0};
  ArrivalRow a = b;
  a.delay_imaginary = -1e-4;
  const ArrivalDifference d = compare_arrivals(one_receiver({a}), one_receiver({b}));
  EXPECT_NEAR(d.amplitude_db.mean, -0.2 * pi * 20.0 / std::log(10.0), 1e-9);
}

TEST(CompareArrivals, EveryPathOfAHasOnePartnerTheNearest) {
  const ArrivalRow row{.amplitude = 1e-3, .delay = 2.0};
  ArrivalRow early = row, late = row;
  early.delay -= 1.5e-3;
  late.delay += 0.5e-3;
  const ArrivalDifference d = compare_arrivals(one_receiver({row}), one_receiver({early, late}));
  EXPECT_EQ(d.matched, 1U);
  EXPECT_NEAR(d.delay_us.mean, -500.0, 1e-6);
}

TEST(CompareArrivals, OtherReceiversAreRefused) {
  ArrivalsFile a = one_receiver({}), b = one_receiver({});
  EXPECT_EQ(compare_arrivals(a, b).matched_pct(), 100.0);  // nothing was to be found
  a.receiver_ranges[0] += 10.0;
  EXPECT_THROW(static_cast<void>(compare_arrivals(a, b)), InputError);
}

// A zigzag of a thousand segments: the nearest point by trying them all.
TEST(Polyline, FindsTheNearestOfAllItsPoints) {
  std::vector<double> range, depth;
  for (int i = 0; i <= 1000; ++i) {
    range.push_back(40.0 * i - 0.02 * i * i);  // goes out and comes back over itself
    depth.push_back(100.0 * std::sin(0.05 * i));
  }
  Polyline line(range, depth);
  for (int i = 0; i < 500; ++i) {
    const double r = std::fmod(7919.0 * i, 21000.0), z = std::fmod(104729.0 * i, 250.0) - 125.0;
    double least = 1e300;
    for (std::size_t k = 0; k + 1 < range.size(); ++k) {
      const double dr = range[k + 1] - range[k], dz = depth[k + 1] - depth[k];
      const double t =
          std::clamp(((r - range[k]) * dr + (z - depth[k]) * dz) / (dr * dr + dz * dz), 0.0, 1.0);
      least = std::min(least, std::hypot(range[k] + t * dr - r, depth[k] + t * dz - z));
    }
    EXPECT_DOUBLE_EQ(line.nearest(r, z).distance, least);
  }
}

RayFile straight(double step, double below, double length) {
  RayFile file;
  for (const double angle : {-2.0, 0.0, 2.0}) {
    RayFile::Ray ray{.launch_angle_deg = angle};
    const double slope = std::tan(angle * pi / 180.0);
    for (double r = 0.0; r <= length; r += step) {
      ray.range.push_back(r);
      ray.depth.push_back(1000.0 + below + slope * r);
    }
    file.rays.push_back(ray);
  }
  return file;
}

// The same lines with other steps, 3 m deeper: 3·cos(angle) from the path.
TEST(CompareRays, DistanceIsFromThePathNotFromThePoints) {
  const RayDifference d = compare_rays(straight(70.0, 3.0, 5000.0), straight(500.0, 0.0, 5000.0));
  EXPECT_EQ(d.paired, 3U);
  EXPECT_NEAR(d.path_m.max, 3.0, 1e-9);
  EXPECT_NEAR(d.inside_m.median, 3.0 * std::cos(2.0 * pi / 180.0), 1e-9);
}

TEST(CompareRays, PointsBeyondTheEndsAreResolved) {
  const RayDifference d = compare_rays(straight(50.0, 0.5, 6000.0), straight(50.0, 0.0, 5000.0));
  EXPECT_GT(d.path_m.median, 990.0);
  EXPECT_NEAR(d.inside_m.max, 0.5, 1e-9);
  EXPECT_LT(d.worst.range, 5001.0);
}

TEST(CompareRays, OtherAnglesArePairedOnlyWithinTheTolerance) {
  const RayFile b = straight(50.0, 0.0, 5000.0);
  RayFile a = b;
  for (auto& ray : a.rays) ray.launch_angle_deg += 0.01;
  EXPECT_EQ(compare_rays(a, b).paired, 0U);
  EXPECT_EQ(compare_rays(a, b, {.angle_deg = 0.02}).paired, 3U);
  a.rays[0].bottom_bounces = 1;  // another history is another ray
  EXPECT_EQ(compare_rays(a, b, {.angle_deg = 0.02}).paired, 2U);
  EXPECT_NEAR(compare_rays(a, b, {.angle_deg = 0.02}).paired_pct(), 200.0 / 3.0, 1e-9);
}

}  // namespace
}  // namespace asdic::detail::compare
