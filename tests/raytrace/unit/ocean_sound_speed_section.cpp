#include "raytrace/ocean/sound_speed_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"

namespace asdic::detail {
namespace {

const std::vector<double> range = {-1000.0, 0.0, 4000.0};
const std::vector<double> depth = {0.0, 50.0, 200.0, 1000.0};
const std::vector<double> speed = {1520.0, 1518.0, 1500.0, 1490.0,   // at −1 km
                                   1515.0, 1510.0, 1495.0, 1491.0,   // at 0
                                   1500.0, 1499.0, 1492.0, 1492.0};  // at 4 km

TEST(SoundSpeedSection, PassesThroughItsSamples) {
  const SoundSpeedSection water(range, depth, speed);
  for (std::size_t i = 0; i < range.size(); ++i)
    for (std::size_t j = 0; j < depth.size(); ++j)
      EXPECT_DOUBLE_EQ(water.at(range[i], depth[j]).c, speed[i * depth.size() + j]);
}

TEST(SoundSpeedSection, CellsBeginAtTheirLines) {
  const SoundSpeedSection water(range, depth, speed);
  EXPECT_EQ(water.cell(-1001.0, 10.0).column, 0U);
  EXPECT_EQ(water.cell(-1000.0, 10.0).column, 1U);
  EXPECT_EQ(water.cell(0.0, 10.0).column, 2U);
  EXPECT_EQ(water.cell(4000.0, 10.0).column, 3U);
  EXPECT_EQ(water.cell(0.0, -10.0).row, 0U);
  EXPECT_EQ(water.cell(0.0, 50.0).row, 1U);
  EXPECT_EQ(water.cell(0.0, 5000.0).row, 2U);
}

// The speed is the same from both sides of a grid line; its gradient jumps by what the samples say.
// 1e-12: speeds of 1500 m/s round at 2e-13.
TEST(SoundSpeedSection, SpeedIsContinuousItsGradientJumps) {
  const SoundSpeedSection water(range, depth, speed);
  for (std::size_t i = 0; i < range.size(); ++i)
    for (const double z : {-20.0, 10.0, 70.0, 500.0, 1500.0}) {
      const std::size_t row = water.cell(0.0, z).row;
      EXPECT_NEAR(water.at(range[i], z, {i, row}).c, water.at(range[i], z, {i + 1, row}).c, 1e-12);
    }
  for (const double r : {-2000.0, -300.0, 1700.0, 9000.0})
    for (std::size_t j = 1; j + 1 < depth.size(); ++j) {
      const std::size_t column = water.cell(r, 0.0).column;
      EXPECT_NEAR(water.at(r, depth[j], {column, j - 1}).c, water.at(r, depth[j], {column, j}).c,
                  1e-12);
    }
  // At range 0, depth 100 m: a third of the way from 50 to 200 m.
  const double here = 1510.0 - 15.0 / 3.0, before = 1518.0 - 18.0 / 3.0, after = 1499.0 - 7.0 / 3.0;
  EXPECT_NEAR(water.at(0.0, 100.0, {1, 1}).c_r, (here - before) / 1000.0, 1e-15);
  EXPECT_NEAR(water.at(0.0, 100.0, {2, 1}).c_r, (after - here) / 4000.0, 1e-15);
  EXPECT_NEAR(water.at(0.0, 50.0, {2, 0}).c_z, -5.0 / 50.0, 1e-15);
  EXPECT_NEAR(water.at(0.0, 50.0, {2, 1}).c_z, -15.0 / 150.0, 1e-15);
}

// c = a + b·r + g·z + d·r·z is reproduced with all its derivatives in every cell, whatever the grid
// (1e-15: derivatives of 1500 m/s over cells of 100 m and more round at 5e-15 m/s per 100 m).
TEST(SoundSpeedSection, ABilinearOceanIsExact) {
  const auto c = [](double r, double z) { return 1500.0 + 1e-3 * r - 0.02 * z + 1e-6 * r * z; };
  std::vector<double> table;
  for (const double r : range)
    for (const double z : depth) table.push_back(c(r, z));
  const SoundSpeedSection water(range, depth, table);
  for (const double r : {-900.0, -1.0, 10.0, 3999.0})
    for (const double z : {-10.0, 20.0, 60.0, 700.0, 1200.0}) {
      const SoundSpeed2D found = water.at(r, z);
      EXPECT_NEAR(found.c, c(r, z), 1e-12 * 1500.0);
      EXPECT_NEAR(found.c_r, 1e-3 + 1e-6 * z, 1e-14);
      EXPECT_NEAR(found.c_z, -0.02 + 1e-6 * r, 1e-13);
      EXPECT_NEAR(found.c_rz, 1e-6, 1e-16);
      EXPECT_EQ(found.c_rr, 0.0);
      EXPECT_EQ(found.c_zz, 0.0);
    }
}

TEST(SoundSpeedSection, OuterProfilesGoOn) {
  const SoundSpeedSection water(range, depth, speed);
  EXPECT_EQ(water.at(-1e6, 50.0).c, 1518.0);
  EXPECT_EQ(water.at(1e6, 50.0).c, 1499.0);
  EXPECT_EQ(water.at(1e6, 50.0).c_r, 0.0);
  const std::vector<double> one = {0.0}, profile = {1500.0, 1510.0, 1500.0, 1490.0};
  const SoundSpeedSection uniform(one, depth, profile);
  for (const double r : {-5.0, 0.0, 5.0}) {
    EXPECT_EQ(uniform.at(r, 25.0).c, 1505.0);
    EXPECT_EQ(uniform.at(r, 25.0).c_r, 0.0);
    EXPECT_EQ(uniform.at(r, 25.0).c_z, 0.2);
  }
}

TEST(SoundSpeedSection, NamesTheNumberAtFault) {
  const auto fault = [](std::vector<double> r, std::vector<double> z, std::vector<double> c) {
    try {
      static_cast<void>(SoundSpeedSection(r, z, c));
    } catch (const InputError& error) {
      return error.fault().where;
    }
    return std::string("none");
  };
  EXPECT_EQ(fault({}, {0.0, 1.0}, {}), "range");
  EXPECT_EQ(fault({0.0, 0.0}, {0.0, 1.0}, {1.0, 1.0, 1.0, 1.0}), "range[1]");
  EXPECT_EQ(fault({0.0}, {0.0}, {1500.0}), "depth");
  EXPECT_EQ(fault({0.0}, {1.0, 0.0}, {1500.0, 1500.0}), "depth[1]");
  EXPECT_EQ(fault({0.0}, {0.0, 1.0}, {1500.0}), "speed");
  EXPECT_EQ(fault({0.0, 1.0}, {0.0, 1.0}, {1.0, 1.0, 1.0, -1.0}), "speed[1][1]");
  EXPECT_EQ(fault({0.0, 1.0}, {0.0, 1.0}, {1.0, std::nan(""), 1.0, 1.0}), "speed[0][1]");
}

}  // namespace
}  // namespace asdic::detail
