#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/units.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "support/oceans.h"

namespace asdic::detail {
namespace {

// Behind the last column rays are followed only as far as a boundary closes in on the water. A
// millimetre of rise at the far end has them followed over all of the opening slope before it: the
// same paths, for nothing there sends a ray back.
TEST(MarchingFan, OpeningSlopesBehindTheReceiverSendNothingBack) {
  Environment near = support::curved_oceans().front().environment, far = near;
  std::vector<double> range = {0.0, 3000.0, 6000.0, 9000.0, 12000.0, 15000.0};
  std::vector<double> depth = {900.0, 600.0, 450.0, 500.0, 700.0, 900.0};
  near.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  range.push_back(16000.0);
  depth.push_back(899.999);
  far.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  const FanLimits limits{
      .lowest = -1.2, .highest = 1.2, .max_surface_bounces = 8, .max_bottom_bounces = 8};
  const std::vector<ReceiverPoint> receivers = {{2500.0, 200.0}, {6500.0, 120.0}, {7000.0, 300.0}};
  const auto few = marching_eigenrays(RayTracer(near, 1000.0), 0.0, 50.0, receivers, limits);
  const auto all = marching_eigenrays(RayTracer(far, 1000.0), 0.0, 50.0, receivers, limits);
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    ASSERT_EQ(few[i].size(), all[i].size());
    EXPECT_GT(few[i].size(), 10U);
    for (std::size_t k = 0; k < few[i].size(); ++k) {
      EXPECT_NEAR(few[i][k].launch_elevation, all[i][k].launch_elevation, 1e-9);
      EXPECT_NEAR(few[i][k].delay, all[i][k].delay, 1e-9);
    }
  }
}

/// A floor that rises by a slope for 200 km behind its first kilometre, under water that traps
/// rays.
Environment rising(double slope) {
  Environment ocean;
  const std::vector<double> depths = {0.0, 100.0, 200.0}, speeds = {1510.0, 1500.0, 1510.0};
  ocean.water = SoundSpeedProfile::table(depths, speeds, Interpolation::c_linear);
  ocean.bottom = {.depth = 200.0, .material = Rigid{}};
  const std::vector<double> range = {0.0, 1000.0, 200e3},
                            depth = {200.0, 200.0, 200.0 - 199e3 * slope};
  ocean.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  return ocean;
}

// Slopes of 1e-7 do not send rays back within a few bounces, so rays are followed no further behind
// the receivers than over a flat floor.
TEST(MarchingFan, GentleSlopesFarBehindTheReceiverCostNothing) {
  const FanLimits limits{.max_surface_bounces = 4, .max_bottom_bounces = 4};
  const std::vector<ReceiverPoint> receivers = {{2000.0, 80.0}};
  SearchWatch flat, gentle;
  const auto without =
      marching_eigenrays(RayTracer(rising(0.0), 1000.0), 0.0, 50.0, receivers, limits, &flat);
  const auto with =
      marching_eigenrays(RayTracer(rising(1e-7), 1000.0), 0.0, 50.0, receivers, limits, &gentle);
  EXPECT_EQ(with[0].size(), without[0].size());
  EXPECT_GT(with[0].size(), 8U);
  EXPECT_LE(gentle.cost.segments, flat.cost.segments * 3 / 2);
}

// Steep rays come back from slopes of 3 % within six bounces, and not from further away than the
// bound on their horizontal slowness says: water given as a section has no such bound, and the
// paths are the same.
TEST(MarchingFan, RaysThatSlopesSendBackAreFollowedFarEnough) {
  const Environment bounded = rising(0.0009), steep = [] {
    Environment ocean = rising(0.0);
    const std::vector<double> range = {0.0, 20.0, 2000.0}, depth = {200.0, 200.0, 140.6};
    ocean.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
    return ocean;
  }();
  int back = 0;
  for (const Environment* ocean : {&bounded, &steep}) {
    Environment open = *ocean;
    const std::vector<double> ends = {0.0, 1e6}, depths = {0.0, 100.0, 200.0},
                              speeds = {1510.0, 1500.0, 1510.0, 1510.0, 1500.0, 1510.0};
    open.section = SoundSpeedSection(ends, depths, speeds);
    const FanLimits limits{.max_surface_bounces = 6, .max_bottom_bounces = 6};
    const std::vector<ReceiverPoint> receivers = {{15.0, 80.0}, {30.0, 120.0}, {60.0, 20.0}};
    const auto found = marching_eigenrays(RayTracer(*ocean, 1e3), 0.0, 50.0, receivers, limits);
    const auto all = marching_eigenrays(RayTracer(open, 1e3), 0.0, 50.0, receivers, limits);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      ASSERT_EQ(found[i].size(), all[i].size()) << i;
      for (std::size_t k = 0; k < found[i].size(); ++k) {
        EXPECT_NEAR(found[i][k].launch_elevation, all[i][k].launch_elevation, 1e-8);
        EXPECT_NEAR(found[i][k].delay, all[i][k].delay, 1e-9);
        back += std::abs(found[i][k].arrival_elevation) > pi / 2.0;
      }
    }
  }
  EXPECT_GT(back, 3);
}

}  // namespace
}  // namespace asdic::detail
