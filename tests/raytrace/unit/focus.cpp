#include "raytrace/waves/focus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/units.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {
namespace {

Environment sea(double gradient) {
  Environment ocean;
  if (gradient != 0.0) {
    const std::vector<double> depths{0.0, 1000.0}, speeds{1500.0, 1500.0 + 1000.0 * gradient};
    ocean.water = SoundSpeedProfile::table(depths, speeds, Interpolation::c_linear);
  }
  ocean.bottom.depth = 1000.0;
  return ocean;
}

/// The worst of all rays from 200 m to a receiver 3 km away.
double worst(double gradient, double receiver_depth, int bounces) {
  const EigenraySolver solver(sea(gradient));
  const PathLimits limits{.max_surface_bounces = bounces, .max_bottom_bounces = bounces};
  const Arrivals rays = solver.find(200.0, receiver_depth, 3000.0, 1000.0, limits);
  EXPECT_FALSE(rays.empty());
  const std::vector<double> errors =
      focusing_errors(solver, 200.0, receiver_depth, 1000.0, limits, rays, 0.0);
  return *std::max_element(errors.begin(), errors.end());
}

// In still water of one speed every path is an image's: spherical spreading is exact, near the
// horizontal as elsewhere, and however many bounces are followed.
TEST(Focus, RaysThatAreStraightHaveNone) {
  for (const double depth : {120.0, 180.0, 200.0, 202.0, 220.0, 900.0})
    for (const int bounces : {0, 1, 5}) EXPECT_EQ(worst(0.0, depth, bounces), 0.0) << depth;
}

// Where the water bends rays by more and more, what they lack grows without a step over 1 dB.
TEST(Focus, RaysThatAreHardlyBentHaveHardlyAny) {
  for (const double gradient : {1e-6, 1e-4, 1e-3, 3e-3, 6e-3, 9e-3, 1e-2, 1.1e-2, 1.2e-2, 1.4e-2,
                                1.7e-2, -1e-3, -1e-2, -1.3e-2, -5e-2})
    for (const double depth : {120.0, 180.0, 202.0, 220.0})
      EXPECT_LT(worst(gradient, depth, 0), 0.12) << gradient << " to " << depth;
}

}  // namespace
}  // namespace asdic::detail
