#pragma once
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "raytrace/ocean/environment.h"
#include "support/oceans.h"

namespace asdic::detail::support {

/// An ocean over a slope, and the receivers that a search is asked for: every depth at every range.
struct SlopingSea {
  std::string name;
  Environment ocean;
  double source_depth, steepest;       ///< [m]; launch elevations within ± that [rad]
  int bounces;                         ///< of each boundary at most
  std::vector<double> ranges, depths;  ///< [m]
  friend void PrintTo(const SlopingSea& s, std::ostream* out) { *out << s.name; }
};

/// Shelves, continental slopes, a seamount and a front out to 10–60 km, under every law of the
/// profile.
inline std::vector<SlopingSea> sloping_seas() {
  using enum ShapeInterpolation;
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  const auto depth = samples(0.0, 4500.0, 46);
  std::vector<double> speed;
  for (const double z : depth) speed.push_back(munk.at(z).c);
  const auto bottom = [](std::vector<double> r, std::vector<double> z, ShapeInterpolation rule) {
    Boundary b{.depth = z.front(), .material = Rigid{}};
    b.shape = BoundaryShape(r, z, rule);
    return b;
  };
  std::vector<SlopingSea> all;

  const std::vector<double> far = {10e3, 19e3, 28e3, 39e3, 50e3, 60e3};
  Environment shelf{.water = SoundSpeedProfile::isovelocity(1500.0)};
  shelf.bottom = bottom({0.0, 60e3}, {300.0, 120.0}, piecewise_linear);
  all.push_back({"Pekeris shelf", shelf, 40.0, 0.25, 60, far, {20.0, 60.0, 110.0}});

  // relief as charts have it: a node a kilometre, slopes of 1 % between
  std::mt19937 generator(7);
  std::normal_distribution<> normal;
  auto r = samples(0.0, 60e3, 61);
  std::vector<double> z;
  for (const double x : r) z.push_back(500.0 - 4e-3 * x + 7.0 * normal(generator));
  Environment facets{.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear)};
  facets.bottom = bottom(r, z, piecewise_linear);
  all.push_back(
      {"facets up a shelf", facets, 60.0, 0.3, 12, {10e3, 19e3, 28e3, 39e3}, {30.0, 150.0}});
  facets.bottom = bottom(r, z, smooth);
  all.push_back(
      {"the same smoothly", facets, 60.0, 0.3, 12, {10e3, 19e3, 28e3, 39e3}, {30.0, 150.0}});

  facets.bottom = bottom(r, z, curvilinear);
  all.push_back(
      {"the same curvilinear", facets, 60.0, 0.3, 12, {10e3, 19e3, 28e3, 39e3}, {30.0, 150.0}});

  Environment down{.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear)};
  down.bottom = bottom({0.0, 5e3, 50e3, 60e3}, {200.0, 250.0, 3500.0, 3800.0}, piecewise_linear);
  all.push_back(
      {"down a continental slope", down, 100.0, 0.6, 20, far, {20.0, 100.0, 180.0, 400.0}});

  Environment up{.water = SoundSpeedProfile::table(depth, speed, Interpolation::spline)};
  up.bottom = bottom({0.0, 10e3, 20e3, 30e3, 40e3, 50e3},
                     {3800.0, 3600.0, 2800.0, 1500.0, 600.0, 300.0}, smooth);
  all.push_back({"up a spline slope", up, 800.0, 0.6, 12, far, {60.0, 160.0, 250.0}});

  z.clear();
  for (const double x : r) z.push_back(4000.0 - 2400.0 * std::exp(-std::pow((x - 32e3) / 9e3, 2)));
  Environment mount{.water = SoundSpeedProfile::table(depth, speed, Interpolation::n2_linear)};
  mount.bottom = bottom(r, z, smooth);
  all.push_back({"over a seamount", mount, 1000.0, 0.6, 10, far, {100.0, 600.0, 1200.0}});

  Environment munk_up{.water = munk};
  munk_up.bottom = bottom({0.0, 60e3}, {4500.0, 1500.0}, piecewise_linear);
  all.push_back({"up a slope under Munk", munk_up, 1300.0, 0.5, 10, far, {150.0, 600.0, 1300.0}});

  Environment front = mount;
  const std::vector<double> sr = {0.0, 15e3, 25e3, 35e3, 60e3};
  const std::vector<double> sz = {0.0, 60.0, 150.0, 300.0, 600.0, 1000.0, 1500.0, 2500.0, 4500.0};
  std::vector<double> section;
  for (const double x : sr)
    for (const double y : sz)
      section.push_back(munk.at(y).c + 8.0 * std::tanh((x - 25e3) / 8e3) * std::exp(-y / 300.0));
  front.section = SoundSpeedSection(sr, sz, section);
  all.push_back(
      {"through a front over a seamount", front, 200.0, 0.5, 10, far, {80.0, 300.0, 900.0}});
  return all;
}

}  // namespace asdic::detail::support
