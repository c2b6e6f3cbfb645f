// Nearly level rays between depths that are equal, almost equal, and a few metres apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytrace/paths/eigenrays.h"
#include "raytrace/places/propagation_paths.h"

namespace asdic::detail {
namespace {

constexpr PathLimits one_bounce{.max_surface_bounces = 1, .max_bottom_bounces = 1};
constexpr PathLimits in_water{.max_surface_bounces = 0, .max_bottom_bounces = 0};

/// Differences of two depths, from the last bit of 50 m to metres.
std::vector<double> differences() {
  std::vector<double> all = {0.0};
  for (const double d : {7.2e-15, 1e-12, 1e-9, 5e-8, 1.01e-7, 3e-7, 9.9e-7, 1.01e-6, 1e-5, 1e-4,
                         1e-3, 1e-2, 0.05, 0.1, 0.3, 1.0, 3.0})
    for (const double sign : {1.0, -1.0}) all.push_back(sign * d);
  return all;
}

// The truth is a sum of images. The direct path is √(r² + d²) long, and four more paths have at
// most one bounce off either boundary.
TEST(LevelPaths, InIsovelocityWaterTheDirectRayIsThereWhateverTheDifference) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.bottom = {.depth = 200.0, .material = FluidHalfSpace{}};
  const EigenraySolver solver(ocean);
  for (const double depth : {0.0, 50.1, 200.0})
    for (const double range : {3.0, 1200.0, 20e3, 300e3})
      for (const double difference : differences()) {
        const double there = depth + difference, apart = there - depth;
        if (there < 0.0 || there > 200.0) continue;
        const Arrivals paths = solver.find(depth, there, range, 4000.0, one_bounce);
        const double length = std::hypot(range, apart);
        const auto direct = std::count_if(paths.begin(), paths.end(),
                                          [](const Arrival& a) { return a.bounces.empty(); });
        ASSERT_EQ(direct, 1) << depth << ' ' << range << ' ' << apart;
        const auto& found = *std::find_if(paths.begin(), paths.end(),
                                          [](const Arrival& a) { return a.bounces.empty(); });
        EXPECT_NEAR(found.delay, length / 1500.0, 1e-9) << depth << ' ' << range << ' ' << apart;
        // The search may miss by 0.01 mm in 3 m, and q of rays at 1e-9 rad is known to 1e-6 of
        // itself.
        EXPECT_NEAR(found.spreading * length, 1.0, 1e-5) << depth << ' ' << range << ' ' << apart;
        EXPECT_NEAR(found.launch_elevation, -std::atan2(apart, range),
                    1e-5 * std::abs(apart) / range + 1e-15);
        if (depth == 50.1) {
          EXPECT_EQ(paths.size(), 5U) << range << ' ' << apart;
        }
      }
}

/// Depth of a ray under its source at a range, by fourth-order Runge–Kutta steps.
struct Followed {
  double depth, slope;
};
Followed follow(const SoundSpeedProfile& water, double depth, double slope, double range,
                double step) {
  const auto bend = [&](double z, double p) {
    const SoundSpeed c = water.at(z);
    return -(1.0 + p * p) * c.dc_dz / c.c;
  };
  const auto steps = static_cast<int>(std::ceil(range / step));
  const double h = range / steps;
  double z = depth, p = slope;
  for (int i = 0; i < steps; ++i) {
    const double k1 = bend(z, p), k2 = bend(z + 0.5 * h * p, p + 0.5 * h * k1),
                 k3 = bend(z + 0.5 * h * (p + 0.5 * h * k1), p + 0.5 * h * k2),
                 k4 = bend(z + h * (p + 0.5 * h * k2), p + h * k3);
    z += h * (p + h / 6.0 * (k1 + k2 + k3));
    p += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return {z, p};
}

struct FlatRoot {
  double slope, q;
};
/// Rays flatter than `most` that reach a depth: a fan with even steps, and with logarithmic steps
/// towards the level, whose roots are bisected.
std::vector<FlatRoot> brute_force(const SoundSpeedProfile& water, double source, double receiver,
                                  double range, double step, double most) {
  std::vector<double> fan = {0.0};
  for (double s = most; s > 1e-3 * std::abs(receiver - source) / range && s > 1e-14; s *= 0.9)
    fan.insert(fan.end(), {s, -s});
  for (int i = 1; i < 40; ++i) fan.insert(fan.end(), {most * i / 40.0, -most * i / 40.0});
  std::sort(fan.begin(), fan.end());
  const auto miss = [&](double slope) {
    return follow(water, source, slope, range, step).depth - receiver;
  };
  std::vector<FlatRoot> found;
  double before = miss(fan.front());
  for (std::size_t i = 1; i < fan.size(); ++i) {
    const double now = miss(fan[i]);
    if ((now > 0.0) != (before > 0.0)) {
      double low = fan[i - 1], high = fan[i];
      for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (low + high);
        ((miss(middle) > 0.0) == (before > 0.0) ? low : high) = middle;
      }
      const double off = std::max(1e-4 * std::abs(low), 1e-9);
      found.push_back({low, (miss(low + off) - miss(low - off)) / (2.0 * off)});
    }
    before = now;
  }
  return found;
}

/// \param share  relative error allowed to angle and q
void expect_flat_rays(const SoundSpeedProfile& water, double bottom, double source, double receiver,
                      double range, double step, double share) {
  constexpr double most = 2e-3;
  Environment ocean;
  ocean.water = water;
  ocean.bottom = {.depth = bottom, .material = FluidHalfSpace{}};
  Arrivals paths = EigenraySolver(ocean).find(source, receiver, range, 1000.0, in_water);
  std::erase_if(paths, [](const Arrival& a) { return std::abs(a.launch_elevation) > most; });
  std::sort(paths.begin(), paths.end(), [](const Arrival& a, const Arrival& b) {
    return a.launch_elevation > b.launch_elevation;
  });
  const std::vector<FlatRoot> truth =
      brute_force(water, source, receiver, range, step, std::tan(most));
  const auto where = testing::Message()
                     << "from " << source << " to " << receiver << " m, " << range << " m";
  ASSERT_EQ(paths.size(), truth.size()) << where;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(-paths[i].launch_elevation, truth[i].slope,
                share * std::abs(truth[i].slope) + 1e-15)
        << where;
    EXPECT_NEAR(std::abs(paths[i].q), std::abs(truth[i].q), share * std::abs(truth[i].q)) << where;
  }
}

// On the axis sin²θ is the difference of two speeds that are equal up to rounding. A flat ray is
// that of a parabola up to the next order in its distance a from the axis, a·c‴/c″ (1.5 m in 650
// m), of which three terms add up. Steeper rays are found by the search, which knows sin² to 1e-8.
TEST(LevelPaths, OnMunksAxisTheNearlyLevelRayIsThereWhateverTheDifference) {
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  for (const double range : {1200.0, 20e3, 33e3, 60e3})
    for (const double source : {1300.0, 1298.0})
      for (const double apart : {1e-9, 1e-4, 1e-2, 0.05, 0.1, 0.3, 1.0, 3.0})
        expect_flat_rays(munk, 5000.0, source, 1300.0 + apart, range, 200.0, 1e-2);
}

// The two sides of this axis bend differently, so it is not a parabola. At knots RK4 is of third
// order, so steps of 5 m change slopes by 1e-5 of themselves.
TEST(LevelPaths, SoIsItOnTheAxisOfAPchipProfile) {
  const SoundSpeedProfile water = SoundSpeedProfile::table(
      std::vector{0.0, 50.0, 100.0, 150.0, 200.0},
      std::vector{1520.0, 1500.0, 1490.0, 1493.0, 1500.0}, Interpolation::pchip);
  for (const double range : {1200.0, 6000.0})
    for (const double source : {100.0, 99.7})
      for (const double apart : {1e-3, 1e-2, 0.1, 1.0})
        expect_flat_rays(water, 200.0, source, 100.0 + apart, range, 5.0, 1e-2);
}

// Along a kink of least speed the level ray is straight, q = r, from a source on the kink and from
// one closer to it than λ/1000 (7.5 mm). A ray marched from there would wind about the kink, with a
// q of at most centimetres. The truth is the layered solver if all profiles are equal, and in any
// section the paths from the kink itself. Half a millimetre of depth changes speeds by 0.5 mm ·
// 0.05 1/s, so delays by 7 ns, and at both ends of a path at 10° by sin 10°/c each.
TEST(LevelPaths, OnAKinkOfASectionTheLevelRayIsOneFromBesideItAsWell) {
  const std::vector<double> range = {0.0, 1200.0}, depth = {0.0, 25.0, 50.0};
  const std::vector<double> profile = {1496.75, 1495.5, 1495.75};
  Environment layered;
  layered.water = SoundSpeedProfile::table(depth, profile, Interpolation::c_linear);
  layered.bottom = {.depth = 50.0, .material = FluidHalfSpace{}};
  Environment section = layered, sheared = layered;
  std::vector<double> twice = profile;
  twice.insert(twice.end(), profile.begin(), profile.end());
  section.section = SoundSpeedSection(range, depth, twice);
  sheared.section = SoundSpeedSection(
      range, depth, std::vector{1495.75, 1495.0, 1495.75, 1497.75, 1496.0, 1495.75});
  const EigenraySolver in_layers(layered), in_section(section), in_shear(sheared);
  const Arrivals truth = in_layers.find(25.0, 25.0, 600.0, 200.0, one_bounce),
                 in_shear_truth = in_shear.find(25.0, 25.0, 600.0, 200.0, one_bounce);
  ASSERT_EQ(truth.size(), 6U);
  const auto expect_same = [](const Arrivals& wanted, const Arrivals& found, double away) {
    ASSERT_EQ(found.size(), wanted.size()) << away;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].delay, wanted[i].delay, 1e-8 + 2.4e-4 * std::abs(away))
          << away << ' ' << i;
      EXPECT_NEAR(found[i].q, wanted[i].q, 1e-3 * std::abs(wanted[i].q)) << away << ' ' << i;
      EXPECT_EQ(found[i].caustics, wanted[i].caustics) << away << ' ' << i;
    }
  };
  for (const double away : {0.0, 2.5e-11, -2.5e-11, 1e-6, -1e-6, 5e-4, -5e-4})
    for (const double there : {25.0, 25.0 + away}) {
      expect_same(truth, in_section.find(25.0 + away, there, 600.0, 200.0, one_bounce), away);
      expect_same(in_shear_truth, in_shear.find(25.0 + away, there, 600.0, 200.0, one_bounce),
                  away);
    }
}

// Both ends at a kink of least speed over a sloping floor, 14 500 wavelengths apart: the rays that
// turn below and above it leave within 0.06° of the line, but a wave does not notice less than
// 0.25°. One stands for all, as loud as a straight one to 1 %, whatever the difference of depths.
// There were two or three of them, and the sound was 6 dB and more too loud.
TEST(LevelPaths, OfAKinkThatWavesDoNotNoticeIsOneOverASlope) {
  Environment ocean;
  ocean.water =
      SoundSpeedProfile::table(std::vector{0.0, 536.5, 1073.0}, std::vector{1496.0, 1495.3, 1504.0},
                               Interpolation::c_linear);
  ocean.bottom = {.depth = 1070.0,
                  .material = FluidHalfSpace{},
                  .shape = BoundaryShape(std::vector{-1000.0, 1000.0}, std::vector{1073.0, 1065.0},
                                         ShapeInterpolation::piecewise_linear)};
  const PropagationPaths paths(ocean, {});
  const PathLimits limits{.max_surface_bounces = 0, .max_bottom_bounces = 0, .diffraction = true};
  for (const double apart : {0.0, 1e-9, 1e-5, 1e-3, -1e-3}) {
    const Arrivals found =
        paths.find({0.0, 0.0, 536.5}, {176.6, 0.0, 536.5 + apart}, 121600.0, limits);
    ASSERT_EQ(found.size(), 1U) << apart;
    EXPECT_NEAR(found.front().spreading * 176.6, 1.0, 0.01) << apart;
  }
}

}  // namespace
}  // namespace asdic::detail
