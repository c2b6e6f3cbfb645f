// Rays beside caustics, and where they would be beyond them, against the wave equation.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "raytrace/propagation.h"
#include "raytrace/waves/airy.h"
#include "raytrace/waves/caustics.h"
#include "support/sum_of.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;
using support::sum_of;

const ReflectionTable nothing_back{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
constexpr PathLimits in_the_water{.max_surface_bounces = 0, .max_bottom_bounces = 0};

/// Munk's channel without boundaries.
Environment channel() {
  return {.water = SoundSpeedProfile::munk(),
          .surface = {.depth = 0.0, .material = nothing_back},
          .bottom = {.depth = 5000.0, .material = nothing_back}};
}

double db(Complex p) { return 20.0 * std::log10(std::abs(p)); }

struct Places {
  double frequency, source, receiver;  // [Hz], depths [m]
  double first, last;                  // ranges [m]
};

/// By the wave equation, every hundredth of the way.
std::vector<Complex> waves_at(const Places& at, std::vector<double>& ranges) {
  PropagationCase c;
  c.environment = channel();
  c.frequency = at.frequency;
  c.source_depths = {at.source};
  c.solver = FieldSolver::waves;
  c.receivers.depths = {at.receiver};
  for (int i = 0; i <= 100; ++i) ranges.push_back(std::lerp(at.first, at.last, 0.01 * i));
  c.receivers.ranges = ranges;
  const PropagationResult result = run(c);
  return {result.field.begin(), result.field.end()};
}

Arrivals rays_of(const EigenraySolver& solver, const Places& at, double range) {
  return solver.find(at.source, at.receiver, range, at.frequency, in_the_water);
}

Arrivals with_caustics(const EigenraySolver& solver, const Places& at, double range) {
  Arrivals found = rays_of(solver, at, range);
  put_caustics(solver, at.source, at.receiver, range, at.frequency, in_the_water, found);
  return found;
}

TEST(Airy, FunctionsOfTheirTables) {  // DLMF table 9.4, and the Wronskian 1/π
  EXPECT_NEAR(airy(1.0).ai, 0.1352924163, 1e-10);
  EXPECT_NEAR(airy(-2.338107410459767).ai, 0.0, 1e-12);
  EXPECT_NEAR(airy(-1.0).bi, 0.1039973895, 1e-10);
  for (double x = -10.0; x <= 6.0; x += 0.37) {
    const Airy<double> w = airy(x);
    EXPECT_NEAR(w.ai * w.bi_slope - w.ai_slope * w.bi, 1.0 / pi, 2e-6) << x;
  }
}

// The first caustic of three geometries, from where it is 25 dB down on the dark side to its second
// interference minimum on the lit side: within 0.5 dB where the sound is, and 3 % of the caustic's
// own in minima.
TEST(Caustics, AreTheWavesOnBothSides) {
  for (const Places& at : {Places{100.0, 1000.0, 1000.0, 35300.0, 40200.0},
                           {100.0, 1000.0, 700.0, 39500.0, 44800.0},
                           {300.0, 300.0, 2500.0, 38700.0, 42500.0}}) {
    const EigenraySolver solver(channel());
    std::vector<double> ranges;
    const std::vector<Complex> waves = waves_at(at, ranges);
    double peak = 0.0, rays_off = 0.0;
    for (const Complex& p : waves) peak = std::max(peak, std::abs(p));
    int beyond = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const Complex got = sum_of(with_caustics(solver, at, ranges[i]), at.frequency);
      const Arrivals rays = rays_of(solver, at, ranges[i]);
      beyond += rays.empty();
      EXPECT_LT(std::abs(got - waves[i]), 0.03 * peak) << ranges[i];
      if (std::abs(waves[i]) > 0.055 * peak) {
        EXPECT_NEAR(db(got), db(waves[i]), 0.5) << ranges[i];
      }
      rays_off = std::max(rays_off, std::abs(sum_of(rays, at.frequency) - waves[i]) / peak);
    }
    EXPECT_GT(beyond, 15);
    EXPECT_GT(rays_off, 0.5);  // rays alone must fail
  }
}

// A receiver that moves through a caustic by millimetres receives no jump.
TEST(Caustics, PassWithoutAJump) {
  const Places at{1000.0, 1000.0, 700.0, 41300.0, 41500.0};
  const EigenraySolver solver(channel());
  double dark = at.first, lit = at.last;
  while (lit - dark > 2e-4) {
    const double middle = 0.5 * (dark + lit);
    (rays_of(solver, at, middle).empty() ? dark : lit) = middle;
  }
  Complex before = sum_of(with_caustics(solver, at, dark - 0.05), at.frequency);
  for (double r = dark - 0.049; r < dark + 0.05; r += 0.001) {
    const Arrivals found = with_caustics(solver, at, r);
    ASSERT_EQ(found.size(), 2U) << r - dark;
    EXPECT_EQ(found[0].kind, ArrivalKind::caustic);
    const Complex now = sum_of(found, at.frequency);
    EXPECT_NEAR(db(now), db(before), 0.003) << r - dark;
    before = now;
  }
}

// Far from any caustic nothing is touched.
TEST(Caustics, LeaveOtherRaysAsTheyAre) {
  const Places at{300.0, 300.0, 2500.0, 0.0, 0.0};
  const EigenraySolver solver(channel());
  for (const double range : {45000.0, 47000.0, 49000.0}) {
    const Arrivals rays = rays_of(solver, at, range), same = with_caustics(solver, at, range);
    ASSERT_EQ(rays.size(), same.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(same[i].kind, ArrivalKind::ray);
      EXPECT_EQ(rays[i].amplitude, same[i].amplitude);
    }
  }
}

}  // namespace
}  // namespace asdic::detail
