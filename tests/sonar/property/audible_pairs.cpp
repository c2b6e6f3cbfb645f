#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/units.h"
#include "reverb/pairs/boundary_fans.h"
#include "reverb/pairs/scattering_sheet.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail {
namespace {

constexpr double speed = 1500.0, range = 6000.0;

/// Water of 150 m with many paths to every place of its bottom.
Environment shallow() {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(speed);
  ocean.bottom = {.depth = 150.0, .material = FluidHalfSpace{.speed = 1700.0}};
  return ocean;
}

/// Limits that fall with the delay and jump from segment to segment.
AudibleLimits limits_of(std::mt19937& random, double highest) {
  std::uniform_real_distribution<double> jump_db(-25.0, 0.0);
  AudibleLimits limits{.segment = 0.25, .least = {}};
  for (int i = 0; i < 40; ++i)
    limits.least.push_back(highest * power_from_db(-2.0 * i + jump_db(random)));
  return limits;
}

void expect_same(const PathPair& pair, const PathPair& plain) {
  EXPECT_EQ(pair.out_index, plain.out_index);
  EXPECT_EQ(pair.back_index, plain.back_index);
  EXPECT_EQ(pair.delay, plain.delay);
  EXPECT_EQ(pair.amplitude, plain.amplitude);
}

// What is left out as too faint in a glance is what is left out pair by pair, to the last bit: for
// a receiver at rest, under way, sinking, one that passes segments, and one too fast for a glance.
TEST(AudiblePairs, AreThoseThatAreLoudEnoughWhenTheyAreReceived) {
  const Environment ocean = shallow();
  const PropagationPaths paths(ocean, {});
  const BoundaryFans fans(paths);
  const Vec3 source(0.0, 0.0, 20.0), receiver(300.0, -100.0, 60.0);
  const BoundaryFans::Settings settings{
      .spacing = 20.0,
      .max_range = range,
      .frequency = 4000.0,
      .limits = {.max_surface_bounces = 8, .max_bottom_bounces = 8}};
  const GroundLevel bottom(BoundaryKind::bottom);
  const auto out = fans.around(source, bottom, settings),
             back = fans.around(receiver, bottom, settings);
  const BeamPattern pattern({.beam = LineBeam{.taper = Taper::omnidirectional}}, speed / 4000.0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-4000.0, 4000.0);
  constexpr double ring = 5e4;  // [m²]
  for (const Vec3& velocity :
       {Vec3(0, 0, 0), Vec3(4, -6, 0), Vec3(1, 2, -1), Vec3(30, -25, 0), Vec3(90, 60, 0)}) {
    SheetEnds ends{.source = {.position = source, .velocity = {3.0, 0.0, 0.0}},
                   .receiver = {.position = receiver, .velocity = velocity}};
    ends.frequency = 4000.0;
    ends.latest = 8.0;
    const ScatteringSheet sheet(out, back, Lambert{.mu_db = -27.0}, ends, pattern);
    PathPairs all, audible;
    std::size_t left_out = 0, found = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec2 there(place(random), place(random));
      sheet.pairs_at(there, all);
      double loudest = 0.0;
      for (const PathPair& pair : all.found) loudest = std::max(loudest, pair.power * ring);
      const AudibleLimits limits = limits_of(random, loudest);
      std::vector<PathPair> plain;
      for (const PathPair& pair : all.found)
        if (pair.power * ring > limits.at(pair.delay)) plain.push_back(pair);
      sheet.pairs_at(there, audible, &limits, ring);
      ASSERT_EQ(audible.found.size(), plain.size()) << i;
      for (std::size_t k = 0; k < plain.size(); ++k) expect_same(audible.found[k], plain[k]);
      found += plain.size();
      left_out += all.found.size() - plain.size();
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(left_out, 1000U);
  }
}

}  // namespace
}  // namespace asdic::detail
