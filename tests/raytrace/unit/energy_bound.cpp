// Paths louder than energy allows are refused, and correct ones are not.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/paths/energy_bound.h"
#include "raytrace/runs/arrivals_run.h"
#include "support/depth_modes.h"

namespace asdic::detail {
namespace {

const LegEnds ends{
    .source_depth = 5.0, .receiver_depth = 54.0, .range = 12945.7, .frequency = 3500.0};

Environment shelf() {
  const std::vector<double> depth = {0.0, 179.0}, speed = {1480.0, 1484.0};
  Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear)};
  ocean.bottom = {.depth = 179.0, .material = FluidHalfSpace{}};
  return ocean;
}

// Deliberate faults: a path, or the sound scattered about it, 100 dB over spherical spreading, and
// an amplitude that is not a number. The message has the numbers.
TEST(EnergyBound, RefusesWhatIsLouder) {
  const Arrival right{.amplitude = 1.0 / 13000.0, .scattered = 1.0 / (13000.0 * 13000.0)};
  EXPECT_NO_THROW(ensure_bounded({right, right}, shelf(), ends));
  Arrival loud = right, scattered = right, nothing = right;
  loud.amplitude *= 1e5;
  scattered.scattered *= 1e10;
  nothing.amplitude = std::numeric_limits<double>::quiet_NaN();
  for (const Arrival& wrong : {loud, scattered, nothing})
    EXPECT_THROW(ensure_bounded({right, wrong, right}, shelf(), ends), RunError);
  try {
    ensure_bounded({right, loud}, shelf(), ends);
    FAIL();
  } catch (const RunError& error) {
    for (const char* part : {"3500 Hz", "12945.7 m", "100.0 dB over", "at most 52.6 dB", "17.7 dB"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

// A ray at the caustic that begins a convergence zone, found by bisection to the last digit, has no
// bound. A run of rays says so.
TEST(EnergyBound, NamesRaysAtACaustic) {
  Environment ocean{.water = SoundSpeedProfile::munk()};
  ocean.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  const double depth = 100.0, frequency = 100.0;
  const PathLimits waterborne{
      .max_surface_bounces = 0, .max_bottom_bounces = 0, .diffraction = false};
  const EigenraySolver solver(ocean);
  const auto rays = [&](double range) {
    return solver.find(depth, depth, range, frequency, waterborne);
  };
  double dark = 40e3, lit = 66e3;
  ASSERT_TRUE(rays(dark).empty());
  ASSERT_FALSE(rays(lit).empty());
  for (int n = 0; n < 60; ++n) (rays(0.5 * (dark + lit)).empty() ? dark : lit) = 0.5 * (dark + lit);

  const LegEnds there{
      .source_depth = depth, .receiver_depth = depth, .range = lit, .frequency = frequency};
  EXPECT_GT(excess(rays(lit), ocean, there), 1.0);
  EXPECT_LT(excess(rays(lit + 500.0), ocean, there), 1e-2);

  PropagationCase c{.environment = ocean};
  c.task = Task::arrivals;
  c.frequency = frequency;
  c.source_depths = {depth};
  c.receivers = {.depths = {depth}, .ranges = {lit, lit + 500.0}};
  c.box_range = 70e3;
  c.box_depth = 5000.0;
  const PropagationResult result = run_arrivals(c);
  std::string all;
  for (const std::string& note : result.notes) all += note + '\n';
  EXPECT_NE(all.find("at 1 of 2 receivers rays are up to"), std::string::npos) << all;
}

// The bound is finite, and some tens of decibels over spherical spreading.
TEST(EnergyBound, IsFinite) {
  const double d2 = ends.range * ends.range;
  EXPECT_NEAR(db_from_power(most_intensity(shelf(), ends) * d2), 50.0, 10.0);
  LegEnds slopes = ends;
  slopes.layered = false;
  EXPECT_LT(db_from_power(most_intensity(shelf(), slopes) * d2), 80.0);
}

// With c = c₀·cosh(az) all rays from the axis meet again after every π/a, the strongest possible
// focus. Its modes, by finite differences and in phase, stay below the bound and come within 27 dB
// of it.
TEST(EnergyBound, LetsAPerfectFocusPass) {
  const double a = 2e-4, axis = 1500.0, f = 100.0, omega = 2.0 * pi * f;
  const auto speed = [&](double z) { return 1500.0 * std::cosh(a * (z - axis)); };
  std::vector<double> depth, speeds;
  for (double z = 0.0; z <= 3000.0; z += 50.0) depth.push_back(z), speeds.push_back(speed(z));
  Environment ocean{.water = SoundSpeedProfile::table(depth, speeds, Interpolation::spline)};
  ocean.bottom = {.depth = 3000.0, .material = FluidHalfSpace{}};
  const auto modes = support::depth_modes(
      f, 3000.0, false, 2000, speed, [](double) { return 1.0; }, omega / speed(0.0),
      omega / 1499.0);
  for (int n = 1; n <= 4; ++n) {
    const double range = n * pi / a;
    std::complex<double> sum = 0.0;
    for (std::size_t m = 0; m < modes.wavenumber.size(); ++m) {
      const double k = modes.wavenumber[m], psi = modes.at(m, axis);
      sum += std::sqrt(2.0 * pi / (range * k)) * psi * psi * std::polar(1.0, -k * range);
    }
    const double bound = most_intensity(
        ocean, {.source_depth = axis, .receiver_depth = axis, .range = range, .frequency = f});
    EXPECT_LT(std::norm(sum), bound) << n;
    EXPECT_GT(std::norm(sum), power_from_db(-27.0) * bound) << n;
  }
}

}  // namespace
}  // namespace asdic::detail
