#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/ocean/depth_function.h"

namespace asdic::detail {
namespace {

TEST(DepthFunction, ANumberIsTheSameEverywhere) {
  const DepthFunction density = 1027.0;
  EXPECT_TRUE(density.is_constant());
  for (const double depth : {-10.0, 0.0, 1e4}) {
    EXPECT_EQ(density.at(depth), 1027.0);
    EXPECT_EQ(density.just_above(depth), 1027.0);
  }
}

TEST(DepthFunction, StraightLinesBetweenSamplesAndConstantBeyond) {
  const std::vector<double> depth = {10.0, 20.0, 60.0}, value = {1.0, 3.0, -1.0};
  const DepthFunction f = DepthFunction::table(depth, value);
  EXPECT_FALSE(f.is_constant());
  EXPECT_EQ(f.at(-5.0), 1.0);
  EXPECT_EQ(f.at(15.0), 2.0);
  EXPECT_EQ(f.at(20.0), 3.0);
  EXPECT_EQ(f.at(40.0), 1.0);
  EXPECT_EQ(f.at(100.0), -1.0);
}

// Two samples at one depth are a step: the value below holds at the step, the other just above it.
TEST(DepthFunction, Steps) {
  const std::vector<double> depth = {10.0, 10.0, 30.0, 30.0}, value = {0.0, 4.0, 4.0, 0.0};
  const DepthFunction layer = DepthFunction::table(depth, value);
  EXPECT_EQ(layer.at(10.0), 4.0);
  EXPECT_EQ(layer.just_above(10.0), 0.0);
  EXPECT_EQ(layer.at(9.999), 0.0);
  EXPECT_EQ(layer.at(20.0), 4.0);
  EXPECT_EQ(layer.just_above(30.0), 4.0);
  EXPECT_EQ(layer.at(30.0), 0.0);
  EXPECT_EQ(layer.at(30.001), 0.0);
}

TEST(DepthFunction, NamesTheSampleAtFault) {
  const auto fault = [](std::vector<double> depth, std::vector<double> value) -> std::string {
    try {
      static_cast<void>(DepthFunction::table(depth, value));
    } catch (const InputError& error) {
      return error.fault().where;
    }
    return "none";
  };
  EXPECT_EQ(fault({}, {}), "depth");
  EXPECT_EQ(fault({0.0, 1.0}, {0.0}), "value");
  EXPECT_EQ(fault({0.0, 2.0, 1.0}, {0.0, 0.0, 0.0}), "depth[2]");
  EXPECT_EQ(fault({0.0, infinity}, {0.0, 0.0}), "depth[1]");
  EXPECT_EQ(fault({0.0, 1.0}, {0.0, -infinity}), "value[1]");
  EXPECT_EQ(fault({0.0, 0.0}, {0.0, 1.0}), "none");
}

}  // namespace
}  // namespace asdic::detail
