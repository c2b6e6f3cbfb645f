#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

#include "raytrace/layered/branch_table.h"
#include "raytrace/paths/eigenrays.h"
#include "support/deep_ocean.h"
#include "support/fan_intervals.h"

namespace asdic::detail {
namespace {

// The fan made of what the ocean keeps is the fan walked anew: the same layers, added in the same
// order up to the association of a layer's own nodes. A rounding of 1e-16 of each of 35 terms; of
// ∂r/∂ξ, in which a turning layer's negative part cancels, of the largest of them, 1/s² of the
// range. Sources and receivers inside layers, on knots, and at the same depth.
TEST(OceanFan, IsTheFanWalkedAnew) {
  for (const char* law : {"c-linear", "n2-linear", "spline", "pchip", "munk"}) {
    const Environment ocean = support::deep_ocean(law);
    const EigenraySolver solver(ocean);
    const std::vector<Layer> layers = make_layers(ocean.water, 0.0, ocean.bottom.depth);
    const OceanFan fan(layers);
    std::size_t nodes = 0;
    for (const double source : {4500.0, 1234.5, 10.0})
      for (const double receiver : {125.0, 700.3, 4000.0, source}) {
        const Column column = solver.table(source, receiver, {})->column();
        const BranchTable kept(column, {}, &ocean, {.layers = layers, .fan = &fan});
        const BranchTable anew(column, {}, &ocean);
        const auto a = support::fan_intervals(kept, 200e3), b = support::fan_intervals(anew, 200e3);
        ASSERT_EQ(a.size(), b.size()) << law;
        for (std::size_t i = 0; i < a.size(); ++i) {
          ASSERT_EQ(a[i]->sigma.size(), b[i]->sigma.size());
          EXPECT_EQ(a[i]->turns_above, b[i]->turns_above);
          EXPECT_EQ(a[i]->turns_below, b[i]->turns_below);
          for (std::size_t k = 0; k < a[i]->sigma.size(); ++k, ++nodes) {
            SCOPED_TRACE(testing::Message() << law << " " << source << " to " << receiver
                                            << " interval " << i << " node " << k);
            const double sigma = a[i]->sigma[k];
            EXPECT_EQ(sigma, b[i]->sigma[k]);
            const double range = b[i]->up[k] + b[i]->middle[k] + b[i]->down[k];
            EXPECT_NEAR(a[i]->up[k], b[i]->up[k], 1e-13 * range);
            EXPECT_NEAR(a[i]->middle[k], b[i]->middle[k], 1e-13 * range);
            EXPECT_NEAR(a[i]->down[k], b[i]->down[k], 1e-13 * range);
            const double slope = std::abs(b[i]->d_up[k]) + std::abs(b[i]->d_middle[k]) +
                                 std::abs(b[i]->d_down[k]) + range / sigma;
            EXPECT_NEAR(a[i]->d_up[k], b[i]->d_up[k], 1e-12 * slope);
            EXPECT_NEAR(a[i]->d_middle[k], b[i]->d_middle[k], 1e-12 * slope);
            EXPECT_NEAR(a[i]->d_down[k], b[i]->d_down[k], 1e-12 * slope);
          }
        }
      }
    EXPECT_GT(nodes, 300U);
  }
}

// The fan of Munk's law is made of the ocean's series, a lane's ray in one piece and its
// neighbour's in the next, right to what is asked of their legs (KeptSeriesAreThePlainSums): 20 µm
// and 3e-9 of the range, 1e-6 of the slope. Where the walk begins with a turn over a short way T =
// s²c/2g (s the sine, g = |dc/dz|), its first of eight nodes lies at 4e-4 of T and weighs 0.05, and
// feels the rounding δ = 2e-13 m/s of c as δ/(2g·4e-4·T) of 1/s: 125·δ/(gs) of the range sc/g. A
// ray level to 1e-10 turns no further than √(2cδ)/g away.
TEST(OceanFan, OfMunksLawIsTheFanWalkedAnew) {
  for (const double depth : {1500.0, 3000.0, 5395.0}) {
    Environment ocean = support::deep_ocean("munk");
    ocean.bottom.depth = depth;
    const EigenraySolver solver(ocean);
    for (const double source : {0.9 * depth, 1234.5, 10.0})
      for (const double receiver : {125.0, 700.3, 0.8 * depth, source}) {
        const auto shared = solver.table(source, receiver, {});
        const BranchTable& kept = *shared;
        ASSERT_NE(kept.kept(), nullptr);
        const BranchTable anew(kept.column(), {}, &ocean);
        const auto a = support::fan_intervals(kept, 200e3), b = support::fan_intervals(anew, 200e3);
        ASSERT_EQ(a.size(), b.size());
        const double g = std::min(std::abs(ocean.water.at(source).dc_dz),
                                  std::abs(ocean.water.at(receiver).dc_dz));
        for (std::size_t i = 0; i < a.size(); ++i) {
          EXPECT_EQ(a[i]->turns_above, b[i]->turns_above);
          EXPECT_EQ(a[i]->turns_below, b[i]->turns_below);
          ASSERT_EQ(a[i]->sigma.size(), b[i]->sigma.size());
          for (std::size_t k = 0; k < a[i]->sigma.size(); ++k) {
            SCOPED_TRACE(testing::Message() << depth << " m, " << source << " to " << receiver
                                            << " interval " << i << " node " << k);
            const double sigma = a[i]->sigma[k];
            EXPECT_EQ(sigma, b[i]->sigma[k]);
            const double range = b[i]->up[k] + b[i]->middle[k] + b[i]->down[k];
            if (!(range < 200e3)) continue;
            const double sine = std::sqrt(
                RayParameter(a[i]->reference_speed, sigma).sine2(kept.column().barrier_speed()));
            const double rounding = std::min(2.5e-11 / (g * sine), 2.5e-5 / g);
            const double error = 2e-5 + 3e-9 * range + rounding;
            EXPECT_NEAR(a[i]->up[k], b[i]->up[k], error);
            EXPECT_NEAR(a[i]->middle[k], b[i]->middle[k], error);
            EXPECT_NEAR(a[i]->down[k], b[i]->down[k], error);
            const double slope = std::abs(b[i]->d_up[k]) + std::abs(b[i]->d_middle[k]) +
                                 std::abs(b[i]->d_down[k]) + range / sigma;
            EXPECT_NEAR(a[i]->d_up[k], b[i]->d_up[k], 1e-6 * slope);
            EXPECT_NEAR(a[i]->d_middle[k], b[i]->d_middle[k], 1e-6 * slope);
            EXPECT_NEAR(a[i]->d_down[k], b[i]->d_down[k], 1e-6 * slope);
          }
        }
      }
  }
}

// In 3000 m of Munk's water the surface is faster than the bottom: between the two speeds rays turn
// in the topmost layer or in any below it, and are bounced by the bottom alone. Truth: Snell's law,
// cos θ/c at the turn.
TEST(OceanFan, TurnsBelowTheSurfaceAreNoBounces) {
  Environment ocean = support::deep_ocean("munk");
  ocean.bottom.depth = 3000.0;
  const double surface = ocean.water.at(0.0).c, bottom = ocean.water.at(3000.0).c;
  const EigenraySolver solver(ocean);
  int turned = 0;
  for (double range = 5e3; range < 50e3; range += 1e3)
    for (const Arrival& a : solver.find(1000.0, 1400.0, range, 1000.0, {})) {
      const double turn_speed = 1.0 / a.horizontal_slowness;
      EXPECT_EQ(turn_speed < surface ? a.surface_bounces : a.upper_turns, 0) << turn_speed;
      EXPECT_EQ(turn_speed < bottom ? a.bottom_bounces : a.lower_turns, 0) << turn_speed;
      turned += turn_speed > bottom && turn_speed < surface && a.upper_turns > 0;
    }
  EXPECT_GT(turned, 50);
}

// Whoever asks first: eight threads with their own depths find what one finds alone, to the bit.
TEST(OceanFan, DoesNotDependOnWhoAsksFirst) {
  const Environment ocean = support::deep_ocean("pchip");
  const auto depth = [](std::size_t i) { return 50.0 + 500.0 * static_cast<double>(i); };
  std::vector<Arrivals> alone;
  for (std::size_t i = 0; i < 8; ++i)
    alone.push_back(EigenraySolver(ocean).find(2000.0, depth(i), 25e3, 1000.0));
  const EigenraySolver shared(ocean);
  std::vector<Arrivals> together(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 8; ++i)
    threads.emplace_back([&, i] { together[i] = shared.find(2000.0, depth(i), 25e3, 1000.0); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_EQ(alone[i].size(), together[i].size());
    for (std::size_t k = 0; k < alone[i].size(); ++k) {
      EXPECT_EQ(alone[i][k].delay, together[i][k].delay);
      EXPECT_EQ(alone[i][k].amplitude, together[i][k].amplitude);
      EXPECT_EQ(alone[i][k].launch_elevation, together[i][k].launch_elevation);
    }
  }
}

}  // namespace
}  // namespace asdic::detail
