// The field by cycles, and rays that are wrong beside it, against the wave equation.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "raytrace/propagation.h"
#include "raytrace/waves/caustics.h"
#include "raytrace/waves/cycles.h"
#include "raytrace/waves/water_window.h"
#include "support/sum_of.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;
using support::sum_of;

const ReflectionTable nothing_back{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};

struct Water {
  Environment ocean;
  PathLimits limits;
};

/// Munk's channel without boundaries.
Water channel() {
  return {{.water = SoundSpeedProfile::munk(),
           .surface = {.depth = 0.0, .material = nothing_back},
           .bottom = {.depth = 5000.0, .material = nothing_back}},
          {.max_surface_bounces = 0, .max_bottom_bounces = 0}};
}

/// 100 m over sediment; the profile of echo_guide.csv.
Water guide(const SoundSpeedProfile& water) {
  Water made{{.water = water}, {.max_surface_bounces = 60, .max_bottom_bounces = 60}};
  made.ocean.water_density = 1000.0;
  made.ocean.bottom = {
      .depth = 100.0,
      .material =
          FluidHalfSpace{.speed = 1700.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.5}};
  return made;
}
Water summer() {
  const std::vector<double> depth = {0.0, 20.0, 40.0, 100.0},
                            speed = {1530.0, 1530.0, 1490.0, 1490.0};
  return guide(SoundSpeedProfile::table(depth, speed, Interpolation::c_linear));
}
Water smooth_summer() {
  std::vector<double> depth, speed;
  for (double z = 0.0; z <= 100.0; z += 2.0) {
    depth.push_back(z);
    speed.push_back(1510.0 - 20.0 * std::tanh((z - 30.0) / 25.0));
  }
  return guide(SoundSpeedProfile::table(depth, speed, Interpolation::spline));
}

struct Places {
  double frequency, source, receiver;  // [Hz], depths [m]
  double first, last;                  // ranges [m]
  int count = 21;
};

std::vector<double> ranges_of(const Places& at) {
  std::vector<double> ranges;
  for (int i = 0; i < at.count; ++i)
    ranges.push_back(std::lerp(at.first, at.last, i / std::max(1.0, at.count - 1.0)));
  return ranges;
}

/// By the wave equation's own integral, all cycles at once.
std::vector<Complex> waves_at(const Water& water, const Places& at) {
  PropagationCase c;
  c.environment = water.ocean;
  c.frequency = at.frequency;
  c.source_depths = {at.source};
  c.solver = FieldSolver::waves;
  c.receivers = {.depths = {at.receiver}, .ranges = ranges_of(at)};
  const PropagationResult result = run(c);
  return {result.field.begin(), result.field.end()};
}

/// The last ones.
CyclesKeeper keeper() {
  struct Last {
    CycleNeed need{};
    std::shared_ptr<const CycleWaves> cycles;
  };
  return [last = std::make_shared<Last>()](const CycleNeed& need, const CyclesMaker& make) {
    if (!last->cycles || !(need == last->need)) *last = {need, make()};
    return last->cycles;
  };
}

Arrivals found(const EigenraySolver& solver, const Water& water, const Places& at, double range,
               bool waves, const CyclesKeeper& keep = {}) {
  Arrivals rays = solver.find(at.source, at.receiver, range, at.frequency, water.limits);
  put_caustics(solver, at.source, at.receiver, range, at.frequency, water.limits, rays);
  if (waves)
    put_waves(solver, at.source, at.receiver, range, at.frequency, water.limits, rays, keep);
  return rays;
}

/// Root mean squares over ranges, as shares of the waves' field: of what is left of an error with
/// waves, and of that of rays and simple caustics.
struct Off {
  double waves = 0.0, rays = 0.0;
};
Off off(const Water& water, const Places& at) {
  const EigenraySolver solver(water.ocean);
  const std::vector<Complex> truth = waves_at(water, at);
  const std::vector<double> ranges = ranges_of(at);
  const CyclesKeeper keep = keeper();
  Off sum;
  double all = 0.0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    all += std::norm(truth[i]);
    sum.waves +=
        std::norm(sum_of(found(solver, water, at, ranges[i], true, keep), at.frequency) - truth[i]);
    sum.rays +=
        std::norm(sum_of(found(solver, water, at, ranges[i], false), at.frequency) - truth[i]);
  }
  return {std::sqrt(sum.waves / all), std::sqrt(sum.rays / all)};
}

// Products of steps against the exponential of every wavenumber. Phases of up to 7·10⁴ rad are
// rounded to 7·10⁻¹² in either.
TEST(Cycles, FactorsOfAWindowAreThoseOfEachWavenumber) {
  const WaterWindow window{.spacing = 2e-3,
                           .offset = 1e-4,
                           .begin = 14.0,
                           .end = 15.5,
                           .low_width = 0.1,
                           .high_width = 0.1,
                           .count = 750};
  constexpr double range = 4321.0;
  const std::vector<Complex> factors = window.factors(range);
  ASSERT_EQ(factors.size(), window.count);
  for (std::size_t j = 0; j < window.count; ++j) {
    const Complex expected =
        std::exp(Complex(0.0, -1.0) * (window.at(j) * range - 0.25 * pi)) / std::sqrt(range);
    EXPECT_NEAR(std::abs(factors[j] / expected - 1.0), 0.0, 3e-11) << j;
  }
}

// The terms and the flat waves add up to the whole field, with both ends on one side of the axis or
// on opposite sides.
TEST(Cycles, TermsAreTheWholeField) {
  for (const Places& at : {Places{100.0, 1000.0, 1000.0, 48000.0, 48000.0, 1},
                           {100.0, 1500.0, 1600.0, 90000.0, 90000.0, 1},
                           {100.0, 700.0, 1500.0, 48000.0, 48000.0, 1}}) {
    const Water water = channel();
    const CycleWaves cycles(water.ocean, at.frequency, at.source, at.receiver, at.last);
    ASSERT_TRUE(cycles.affordable());
    Complex sum = 0.0;
    double energy = 0.0;
    for (const Complex& p : cycles.terms(6, at.last)) sum += p, energy += std::norm(p);
    EXPECT_LT(std::abs(sum - waves_at(water, at)[0]), 2e-3 * std::sqrt(energy)) << at.source;
  }
}

// About the range at which all rays about the horizontal come together: 1 % of the field, where
// rays are off by more than the field.
TEST(Cycles, FociHaveTheWavesLevel) {
  for (const double frequency : {50.0, 100.0, 300.0})
    for (const double depth : {1000.0, 1500.0}) {
      const Off left = off(channel(), {frequency, depth, depth, 46010.0, 50010.0, 41});
      EXPECT_LT(left.waves, 0.01) << frequency << " Hz, " << depth;
      EXPECT_GT(left.rays, 0.5) << frequency << " Hz, " << depth;
    }
  EXPECT_LT(off(channel(), {100.0, 1000.0, 1500.0, 44000.0, 54000.0}).waves, 0.01);
  EXPECT_LT(off(channel(), {100.0, 1000.0, 1010.0, 44000.0, 54000.0}).waves, 0.01);
}

// Beside simple caustics, on their dark sides too, as far as there are rays.
TEST(Cycles, CausticsStayTheWaves) {
  EXPECT_LT(off(channel(), {100.0, 1000.0, 700.0, 39500.0, 52000.0, 41}).waves, 0.01);
  EXPECT_LT(off(channel(), {300.0, 300.0, 2500.0, 38700.0, 45000.0, 41}).waves, 0.01);
}

// Ten turns beside the corners of a thermocline, below, within and above it: 1 %, where rays are
// off by half of the field or all of it.
TEST(Cycles, TurnsBesideCornersAreTheWaves) {
  for (const double frequency : {250.0, 1000.0, 3500.0})
    for (const auto& [source, receiver] : {std::pair{50.0, 60.0}, {30.0, 60.0}, {30.0, 20.0}}) {
      const Off left = off(summer(), {frequency, source, receiver, 9950.0, 10050.0});
      EXPECT_LT(left.waves, 0.015) << frequency << " Hz, " << source << " m";
      EXPECT_GT(left.rays, 0.1) << frequency << " Hz, " << source << " m";
    }
  EXPECT_LT(off(summer(), {500.0, 30.0, 60.0, 1000.0, 3000.0}).waves, 0.01);
  EXPECT_LT(off(smooth_summer(), {3500.0, 60.0, 50.0, 9950.0, 10050.0}).waves, 0.015);
}

// A source in a surface duct and a receiver below the axis: the speed rises downwards at both, but
// between them lies the slowest depth. Waves that cannot leave the duct are next to nothing below,
// not the e¹⁰⁰ that they would be if they turned below both ends.
TEST(Cycles, ADuctAboveTheAxisIsReceivedBelowIt) {
  const std::vector<double> depth = {0.0, 35.0, 50.0, 75.0, 100.0, 300.0},
                            speed = {1522.8, 1523.3, 1522.8, 1513.0, 1506.8, 1510.2};
  Water water = channel();
  water.ocean.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  water.ocean.bottom.depth = 300.0;
  for (const auto& [source, receiver] : {std::pair{7.0, 160.0}, {160.0, 7.0}, {20.0, 130.0}})
    for (const double frequency : {500.0, 1500.0}) {
      const Places at{frequency, source, receiver, 3000.0, 3500.0};
      EXPECT_LT(off(water, at).waves, 0.02) << frequency << " Hz, " << source << " m";
    }
}

// Both ends lie where the speed is greatest, at a node of the profile or a millimetre from it. The
// slope is 0 there, and waves that turned on the wrong side were e¹²⁰ times too large.
TEST(Cycles, EndsAtTheGreatestSpeed) {
  const std::vector<double> depth = {0.0, 20.0, 46.712, 80.0, 110.0},
                            speed = {1485.0, 1488.0, 1495.0, 1492.0, 1487.0};
  Water water = guide(SoundSpeedProfile::table(depth, speed, Interpolation::pchip));
  water.ocean.bottom.depth = 110.0;
  for (const double apart : {0.0, 1e-3, -1e-3, 9e-3}) {
    const Places at{1717.0, 46.712, 46.712 + apart, 1520.0, 1540.0, 5};
    EXPECT_LT(off(water, at).waves, 0.03) << apart;
  }
}

// Boundaries that rays must not touch return nothing to waves.
TEST(Cycles, BouncesBeyondTheLimitAreLeftOut) {
  Water reflecting = channel();
  reflecting.ocean.surface.material = Vacuum{};
  reflecting.ocean.bottom.material = Rigid{};
  const Places at{100.0, 1000.0, 1000.0, 47000.0, 49000.0, 5};
  const EigenraySolver solver(reflecting.ocean);
  const std::vector<Complex> truth = waves_at(channel(), at);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_LT(
        std::abs(sum_of(found(solver, reflecting, at, ranges_of(at)[i], true), 100.0) - truth[i]),
        0.01 * std::abs(truth[i]));
}

// Source and receiver exchanged: the same sound, out of the waves that are known. A ray whose
// amplitude changes by less than 0.1 % of the whole stays one, the way there or the way back.
TEST(Cycles, TheWayBackHasTheSameWaves) {
  for (const auto& [water, at] : {std::pair{channel(), Places{100.0, 1000.0, 1500.0, 48010.0, 0.0}},
                                  {summer(), {1000.0, 30.0, 60.0, 10000.0, 0.0}},
                                  {summer(), {1000.0, 60.0, 70.0, 10000.0, 0.0}}}) {
    const EigenraySolver solver(water.ocean);
    const CyclesKeeper keep = keeper();
    int made = 0;
    const CyclesKeeper counted = [&](const CycleNeed& need, const CyclesMaker& make) {
      return keep(need, [&] {
        ++made;
        return make();
      });
    };
    Places back = at;
    std::swap(back.source, back.receiver);
    const Complex there = sum_of(found(solver, water, at, at.first, true, counted), at.frequency);
    const int before = made;
    EXPECT_GT(before, 0);
    const Complex home = sum_of(found(solver, water, back, at.first, true, counted), at.frequency);
    EXPECT_EQ(made, before);
    EXPECT_LT(std::abs(home - there), 2e-3 * std::abs(there));
  }
}

// A target that moves by millimetres receives no jump, and has the paths it had.
TEST(Cycles, PassWithoutAJump) {
  for (const auto& [water, at] : {std::pair{channel(), Places{100.0, 1000.0, 1000.0, 47000.0, 0.0}},
                                  {channel(), {100.0, 1000.0, 1000.0, 48010.0, 0.0}},
                                  {summer(), {1000.0, 30.0, 60.0, 10000.0, 0.0}}}) {
    const EigenraySolver solver(water.ocean);
    const CyclesKeeper keep = keeper();
    Complex before = 0.0;
    for (int i = 0; i < 40; ++i) {
      const Complex now =
          sum_of(found(solver, water, at, at.first + 1e-3 * i, true, keep), at.frequency);
      if (i > 0) {
        EXPECT_LT(std::abs(now - before), 0.01 * std::abs(before)) << i;
      }
      before = now;
    }
  }
}

// Where rays are right, or waves too dear, they stay what they are, bit for bit.
TEST(Cycles, LeaveOtherRaysAsTheyAre) {
  const auto expect_same = [](const Water& water, const Places& at) {
    const EigenraySolver solver(water.ocean);
    const Arrivals rays = found(solver, water, at, at.first, false),
                   same = found(solver, water, at, at.first, true);
    ASSERT_EQ(rays.size(), same.size());
    ASSERT_FALSE(rays.empty());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(rays[i].kind, same[i].kind);
      EXPECT_EQ(rays[i].amplitude, same[i].amplitude);
    }
  };
  // At 1 kHz the floor reflects round waves 3 % otherwise than plane ones.
  expect_same(guide(SoundSpeedProfile::isovelocity(1500.0)), {10000.0, 30.0, 60.0, 10000.0, 0.0});
  expect_same(channel(), {1000.0, 300.0, 2500.0, 45000.0, 0.0});   // far from any focus
  expect_same(channel(), {5000.0, 1000.0, 1000.0, 48010.0, 0.0});  // too dear
}

}  // namespace
}  // namespace asdic::detail
