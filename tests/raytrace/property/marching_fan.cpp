#include <gtest/gtest.h>

#include <vector>

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

}  // namespace
}  // namespace asdic::detail
