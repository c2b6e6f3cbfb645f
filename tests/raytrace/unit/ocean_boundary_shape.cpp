#include "raytrace/ocean/boundary_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {
namespace {

constexpr ShapeInterpolation every_shape[] = {ShapeInterpolation::piecewise_linear,
                                              ShapeInterpolation::smooth,
                                              ShapeInterpolation::curvilinear};

const std::vector<double> range = {-500.0, 0.0, 1000.0, 2500.0, 3000.0};
const std::vector<double> depth = {3000.0, 2950.0, 2500.0, 2600.0, 2900.0};

TEST(BoundaryShape, MeetsItsNodesFromBothSides) {
  for (const auto kind : every_shape) {
    const BoundaryShape shape(range, depth, kind);
    ASSERT_EQ(shape.facets(), range.size() + 1);
    for (std::size_t i = 0; i < range.size(); ++i) {
      // Exactly for straight facets, measured from the nearer node; a cubic sums three terms.
      EXPECT_NEAR(shape.depth_at(range[i], i), depth[i], 1e-12 * depth[i]) << name(kind);
      EXPECT_EQ(shape.depth_at(range[i], i + 1), depth[i]) << name(kind);
    }
    EXPECT_EQ(shape.depth_at(-1e6), 3000.0);
    EXPECT_EQ(shape.depth_at(1e6), 2900.0);
    EXPECT_EQ(shape.at(1e6).slope, 0.0);
    EXPECT_EQ(shape.at(1e6).curvature, 0.0);
  }
}

TEST(BoundaryShape, ANodeBelongsToTheFacetAfterIt) {
  const BoundaryShape shape(range, depth, ShapeInterpolation::piecewise_linear);
  EXPECT_EQ(shape.facet(-501.0), 0U);
  EXPECT_EQ(shape.facet(-500.0), 1U);
  EXPECT_EQ(shape.facet(0.0), 2U);
  EXPECT_EQ(shape.facet(999.9), 2U);
  EXPECT_EQ(shape.facet(3000.0), 5U);
  EXPECT_EQ(shape.facet_begin(0), -infinity);
  EXPECT_EQ(shape.facet_end(0), -500.0);
  EXPECT_EQ(shape.facet_begin(2), 0.0);
  EXPECT_EQ(shape.facet_end(2), 1000.0);
  EXPECT_EQ(shape.facet_end(5), infinity);
  EXPECT_EQ(shape.at(0.0).slope, -0.45);    // 450 m up in 1 km
  EXPECT_EQ(shape.at(0.0, 1).slope, -0.1);  // 50 m up in 500 m
  EXPECT_EQ(shape.at(500.0).depth, 2725.0);
}

// A smooth boundary is one curve: slope and curvature are what differences of the depth say, and
// the slope is the same on both sides of every node, the outer ones included. Central differences
// over h err by h²·|z‴|/6; the sharpest facet here has |z‴| ≈ 12·300/500³ = 3e-5 m⁻².
TEST(BoundaryShape, SmoothIsOneCurve) {
  const BoundaryShape shape(range, depth, ShapeInterpolation::smooth);
  const double h = 0.1;
  for (double r = -499.0; r < 2999.0; r += 7.3) {
    const std::size_t i = shape.facet(r);
    const BoundaryPoint point = shape.at(r, i);
    const double after = shape.depth_at(r + h, i), before = shape.depth_at(r - h, i);
    EXPECT_NEAR(point.slope, (after - before) / (2.0 * h), 1e-5 * h * h);
    // dφ/ds = d(atan z′)/dr·cos φ. κ ≤ 0.006/m changes over a quarter of a facet, 125 m and more:
    // the difference errs by h²/6·0.006/125² = 6e-10.
    const double turned = std::atan(shape.at(r + h, i).slope) - std::atan(shape.at(r - h, i).slope);
    EXPECT_NEAR(point.curvature, turned / (2.0 * h) / std::hypot(1.0, point.slope), 1e-9);
  }
  for (std::size_t i = 0; i < range.size(); ++i)
    EXPECT_NEAR(shape.at(range[i], i).slope, shape.at(range[i], i + 1).slope, 1e-14);
  EXPECT_NEAR(shape.at(1000.0).slope, (2600.0 - 2950.0) / 2500.0, 1e-14);
}

// A smooth hill is higher than its nodes; limits must know.
TEST(BoundaryShape, LimitsIncludeTheCrests) {
  for (const auto kind : every_shape) {
    const BoundaryShape shape(range, depth, kind);
    double least = 1e9, most = -1e9;
    for (double r = -600.0; r < 3100.0; r += 0.1) {
      least = std::min(least, shape.depth_at(r));
      most = std::max(most, shape.depth_at(r));
    }
    // 0.1 m from a crest of radius 200 m the depth differs by 3e-5 m at most.
    EXPECT_LE(shape.shallowest(), least + 1e-12);
    EXPECT_NEAR(shape.shallowest(), least, 3e-5);
    EXPECT_GE(shape.deepest(), most - 1e-12);
    EXPECT_NEAR(shape.deepest(), most, 3e-5);
  }
}

// Curvilinear: straight facets, tangents that turn from node to node. Unit tangents of the facets
// here: (1, 0), then (0.8, 0.6): node 1 has their mean, (0.9, 0.3), slope 1/3; and so has node 2,
// after which the boundary is flat. κ = dφ/ds = (a × b)/|t|²/length: 0 where the tangent does not
// turn.
TEST(BoundaryShape, CurvilinearTurnsItsTangent) {
  const std::vector<double> r = {0.0, 100.0, 180.0}, z = {50.0, 50.0, 110.0};
  const BoundaryShape shape(r, z, ShapeInterpolation::curvilinear);
  EXPECT_EQ(shape.at(140.0).depth, 80.0);
  EXPECT_EQ(shape.at(0.0).slope, 0.0);
  EXPECT_NEAR(shape.at(100.0).slope, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(shape.at(100.0, 1).slope, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(shape.at(50.0).slope, 0.15 / 0.95, 1e-15);  // halfway from (1, 0) to (0.9, 0.3)
  EXPECT_NEAR(shape.at(180.0, 2).slope, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(shape.at(50.0).curvature, 0.3 / (0.95 * 0.95 + 0.15 * 0.15) / 100.0, 1e-17);
  EXPECT_NEAR(shape.at(150.0).curvature, 0.0, 1e-17);
}

// On a parabola both curved rules find the curvature 1/R of its crest (1e-3: facets of 100 m on a
// hill of 20 km radius).
TEST(BoundaryShape, BothCurvedRulesKnowAHill) {
  std::vector<double> r, z;
  for (int i = -20; i <= 20; ++i) {
    r.push_back(100.0 * i);
    z.push_back(3000.0 + 1e4 * i * i / (2.0 * 20e3));
  }
  for (const auto kind : {ShapeInterpolation::smooth, ShapeInterpolation::curvilinear})
    for (const double x : {-50.0, 20.0, 75.0})
      EXPECT_NEAR(BoundaryShape(r, z, kind).at(x).curvature, 1.0 / 20e3, 1e-3 / 20e3) << name(kind);
}

TEST(BoundaryShape, OneNodeIsAFlatBottom) {
  const std::vector<double> r = {0.0}, z = {100.0};
  for (const auto kind : every_shape) {
    const BoundaryShape shape(r, z, kind);
    EXPECT_EQ(shape.facets(), 2U);
    for (const double x : {-1.0, 0.0, 1.0}) EXPECT_EQ(shape.at(x).depth, 100.0);
  }
}

// The material of node i holds from there to node i + 1; the first also before, the last beyond.
TEST(BoundaryShape, MaterialsChangeAtTheNodes) {
  const std::vector<double> r = {0.0, 100.0}, z = {50.0, 60.0};
  Boundary bottom{.depth = 50.0, .material = Vacuum{}};
  EXPECT_TRUE(std::holds_alternative<Vacuum>(bottom.material_at(0.0)));
  bottom.shape.emplace(r, z, ShapeInterpolation::piecewise_linear);
  EXPECT_TRUE(std::holds_alternative<Vacuum>(bottom.material_at(0.0)));
  bottom.shape.emplace(r, z, ShapeInterpolation::piecewise_linear,
                       std::vector<BoundaryMaterial>{Rigid{}, FluidHalfSpace{}});
  EXPECT_TRUE(std::holds_alternative<Rigid>(bottom.material_at(-1.0)));
  EXPECT_TRUE(std::holds_alternative<Rigid>(bottom.material_at(99.9)));
  EXPECT_TRUE(std::holds_alternative<FluidHalfSpace>(bottom.material_at(100.0)));
  EXPECT_EQ(bottom.depth_at(50.0), 55.0);
}

TEST(BoundaryShape, NamesTheNodeAtFault) {
  const auto fault = [](std::vector<double> r, std::vector<double> z, std::size_t materials = 0) {
    try {
      static_cast<void>(BoundaryShape(r, z, ShapeInterpolation::smooth,
                                      std::vector<BoundaryMaterial>(materials, Rigid{})));
    } catch (const InputError& error) {
      return error.fault().where;
    }
    return std::string("none");
  };
  EXPECT_EQ(fault({}, {}), "range");
  EXPECT_EQ(fault({0.0, 1.0}, {5.0}), "depth");
  EXPECT_EQ(fault({0.0, 1.0, 1.0}, {5.0, 5.0, 5.0}), "range[2]");
  EXPECT_EQ(fault({0.0, 1.0}, {5.0, std::nan("")}), "depth[1]");
  EXPECT_EQ(fault({0.0, 1.0}, {5.0, 5.0}, 1), "material");
  EXPECT_EQ(fault({0.0, 1.0}, {5.0, 5.0}, 2), "none");
}

}  // namespace
}  // namespace asdic::detail
