// How far the rings of a grid of scatterers lie apart.
#include "reverb/fields/ground_spacing.h"

#include <gtest/gtest.h>

#include <array>

namespace asdic::detail {
namespace {

constexpr double bandwidth = 50.0, c = 1500.0;  // [Hz], [m/s]: c/(4B) = 7.5 m

TEST(GroundSpacing, IsTheSettingElseOfTheBandwidth) {
  ReverberationSettings settings;
  const Environment ocean;
  EXPECT_DOUBLE_EQ(ground_spacing(settings, ocean, bandwidth, c), 7.5);
  settings.ground_spacing = 40.0;
  EXPECT_DOUBLE_EQ(ground_spacing(settings, ocean, bandwidth, c), 40.0);
}

// Facets of 3 m are finer than the bandwidth asks for, those of 10 cm finer than any grid.
TEST(GroundSpacing, SamplesASurfaceWithAShapeFacetByFacet) {
  const auto spacing = [](double facet) {
    const std::array<double, 3> ranges = {0.0, facet, 2.0 * facet}, depths = {0.0, 0.05, 0.0};
    Environment ocean;
    ocean.surface.shape = BoundaryShape(ranges, depths, ShapeInterpolation::piecewise_linear);
    return ground_spacing({}, ocean, bandwidth, c);
  };
  EXPECT_DOUBLE_EQ(spacing(100.0), 7.5);
  EXPECT_DOUBLE_EQ(spacing(3.0), 3.0);
  EXPECT_DOUBLE_EQ(spacing(0.1), 1.0);
}

}  // namespace
}  // namespace asdic::detail
