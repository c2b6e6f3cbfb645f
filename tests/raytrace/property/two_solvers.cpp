#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/paths/eigenrays.h"
#include "raytrace/tracing/marching_eigenrays.h"

// Where both solvers apply they agree to rounding: layered oceans under every law of the profile.
namespace asdic::detail {
namespace {

struct Law {
  const char* name;
  SoundSpeedProfile water;
  double amplitude;  ///< agreement, relative
};

/// A Munk profile in 31 samples, as a measured one would be, under each rule; or Munk's law itself.
std::vector<Law> laws() {
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  const std::vector<double> depth = {
      0,   10,  20,   30,   50,   75,   100,  125,  150,  200,  250,  300,  400,  500,  600, 700,
      800, 900, 1000, 1100, 1200, 1300, 1500, 2000, 2500, 3000, 3500, 4000, 4500, 5000, 5500};
  std::vector<double> speed;
  for (const double z : depth) speed.push_back(munk.at(z).c);
  const auto table = [&](Interpolation rule) {
    return SoundSpeedProfile::table(depth, speed, rule);
  };
  return {{"c_linear", table(Interpolation::c_linear), 1e-6},
          {"n2_linear", table(Interpolation::n2_linear), 1e-6},
          {"spline", table(Interpolation::spline), 1e-6},
          {"pchip", table(Interpolation::pchip), 1e-6},
          {"pchip_spline_slopes", table(Interpolation::pchip_spline_slopes), 1e-6},
          {"munk", munk, 1e-6}};
}

class TwoSolvers : public testing::TestWithParam<Law> {};
INSTANTIATE_TEST_SUITE_P(Laws, TwoSolvers, testing::ValuesIn(laws()),
                         [](const auto& test) { return std::string(test.param.name); });

// Both find a root to 1e-5 m or better: of a delay that is 1e-14 of itself (the delay is corrected
// for the miss), of an amplitude q′δα/(2q) with δα = 1e-5 m/q and q′/q of at most 1e4 here: 1e-6.
// The layered solver's quadrature and the tracer's steps of smooth laws are right to 1e-10 in
// delay.
TEST_P(TwoSolvers, AgreeToRounding) {
  Environment ocean{.water = GetParam().water};
  ocean.bottom = {.depth = 5395.0, .material = FluidHalfSpace{}};
  ocean.absorption = Thorp{};
  const EigenraySolver solver(ocean);
  ASSERT_TRUE(solver.layered());
  const RayTracer tracer(ocean, 1000.0);
  const PathLimits limits{
      .max_surface_bounces = 3, .max_bottom_bounces = 3, .max_launch_angle = 1.4};
  const FanLimits fan{
      .lowest = -1.4, .highest = 1.4, .max_surface_bounces = 3, .max_bottom_bounces = 3};
  std::vector<ReceiverPoint> receivers;
  for (const double range : {3e3, 17e3, 41e3})
    for (const double depth : {125.0, 800.0}) receivers.push_back({range, depth});
  for (const double source : {4500.0, 1000.0}) {
    const auto layered = solver.find(source, receivers, 1000.0, limits);
    const auto marched = marching_eigenrays(tracer, 0.0, source, receivers, fan);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      ASSERT_EQ(layered[i].size(), marched[i].size());
      for (std::size_t k = 0; k < layered[i].size(); ++k) {
        const Arrival &a = layered[i][k], &b = marched[i][k];
        EXPECT_NEAR(a.delay, b.delay, 1e-9 * a.delay);
        EXPECT_NEAR(std::abs(a.amplitude - b.amplitude), 0.0,
                    GetParam().amplitude * std::abs(a.amplitude));
        EXPECT_NEAR(a.launch_elevation, b.launch_elevation, 1e-8);
        EXPECT_NEAR(a.arrival_elevation, b.arrival_elevation, 1e-8);
        EXPECT_NEAR(a.path_length, b.path_length, 1e-9 * a.path_length);
        EXPECT_NEAR(a.absorption_db, b.absorption_db, 1e-8);
        EXPECT_EQ(a.surface_bounces, b.surface_bounces);
        EXPECT_EQ(a.bottom_bounces, b.bottom_bounces);
        EXPECT_EQ(a.upper_turns, b.upper_turns);
        EXPECT_EQ(a.lower_turns, b.lower_turns);
        EXPECT_EQ(a.caustics, b.caustics);
      }
    }
  }
}

}  // namespace
}  // namespace asdic::detail
