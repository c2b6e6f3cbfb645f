#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytrace/ocean/sound_speed.h"

namespace asdic::detail {
namespace {

double between(double low, double high) {
  constexpr int steps = 1'000'000;
  return low + (high - low) * *rc::gen::inRange(0, steps + 1) / steps;
}

struct Samples {
  std::vector<double> depth, speed;
};

Samples any_ocean() {
  Samples samples;
  const int n = *rc::gen::inRange(2, 12);
  double z = between(-10.0, 10.0);
  for (int i = 0; i < n; ++i) {
    samples.depth.push_back(z);
    samples.speed.push_back(between(1430.0, 1560.0));
    z += between(50.0, 400.0);
  }
  return samples;
}

// Central differences over ±h err by h²/6 times the third derivative, and by the rounding of c and
// of the depth: ε·c/h = 4e-11 /s in c′; 5e-13 m of 4 km over h, 5e-11 of c″, in c″. Secants stay
// below 130/50 /s; a spline's slopes may exceed them several times where narrow and wide intervals
// meet, and its c‴ = 6a₃ is then at most some 0.1 /(m²·s): h = 0.01 m leaves 2e-6 /s of c′. c″ is a
// straight line for cubics, so its difference is exact; n²-linear has c⁗ = 105c′⁴/c³, below 1e-6.
RC_GTEST_PROP(SoundSpeedProfile, DerivativesAreThoseOfTheSpeed, ()) {
  const Samples ocean = any_ocean();
  const auto rule =
      *rc::gen::element(Interpolation::c_linear, Interpolation::n2_linear, Interpolation::spline,
                        Interpolation::pchip, Interpolation::pchip_spline_slopes);
  const auto water = SoundSpeedProfile::table(ocean.depth, ocean.speed, rule);
  const auto i = *rc::gen::inRange<std::size_t>(0, water.intervals());
  constexpr double h = 0.01;
  const double z = between(ocean.depth[i] + 1.1 * h, ocean.depth[i + 1] - 1.1 * h);
  const SoundSpeed up = water.at(z - h), here = water.at(z), down = water.at(z + h);
  RC_ASSERT(std::abs((down.c - up.c) / (2.0 * h) - here.dc_dz) < 2e-6);
  RC_ASSERT(std::abs((down.dc_dz - up.dc_dz) / (2.0 * h) - here.d2c_dz2) < 1e-9);
}

// No overshoot, and monotone between neighbouring samples.
RC_GTEST_PROP(SoundSpeedProfile, PchipIsMonotoneBetweenSamples, ()) {
  const Samples ocean = any_ocean();
  const auto rule = *rc::gen::element(Interpolation::pchip, Interpolation::pchip_spline_slopes);
  const auto water = SoundSpeedProfile::table(ocean.depth, ocean.speed, rule);
  constexpr double rounding = 1e-11;  // of speeds near 1500 m/s, several operations
  for (std::size_t i = 0; i < water.intervals(); ++i) {
    const double a = ocean.speed[i], b = ocean.speed[i + 1];
    const double width = ocean.depth[i + 1] - ocean.depth[i];
    const double sense = b >= a ? 1.0 : -1.0;
    double before = a;
    for (int k = 1; k <= 50; ++k) {
      const double c = water.at(ocean.depth[i] + width * k / 50.0, i).c;
      RC_ASSERT(sense * (c - before) >= -rounding);
      RC_ASSERT(c >= std::min(a, b) - rounding && c <= std::max(a, b) + rounding);
      before = c;
    }
  }
}

// 1/√x is convex: the line of 1/c² lies below the line of c.
RC_GTEST_PROP(SoundSpeedProfile, InverseSquareLineLiesBelowTheLine, ()) {
  const Samples ocean = any_ocean();
  const auto line = SoundSpeedProfile::table(ocean.depth, ocean.speed, Interpolation::c_linear);
  const auto n2 = SoundSpeedProfile::table(ocean.depth, ocean.speed, Interpolation::n2_linear);
  const double z = between(ocean.depth.front(), ocean.depth.back());
  RC_ASSERT(n2.at(z).c <= line.at(z).c + 1e-11);
}

// The same depth answered by at(z) and by the law of the interval that holds it, bit for bit.
RC_GTEST_PROP(SoundSpeedProfile, IntervalHoldsItsDepth, ()) {
  const Samples ocean = any_ocean();
  const auto water = SoundSpeedProfile::table(ocean.depth, ocean.speed, Interpolation::pchip);
  const double z = between(ocean.depth.front(), ocean.depth.back());
  const std::size_t i = water.interval(z);
  RC_ASSERT(ocean.depth[i] <= z && z <= ocean.depth[i + 1]);
  RC_ASSERT(water.at(z).c == water.at(z, i).c);
}

}  // namespace
}  // namespace asdic::detail
