#pragma once
#include <string_view>
#include <vector>

#include "raytrace/ocean/environment.h"

namespace asdic::detail::support {

/// The deep ocean of the thesis, 5395 m over a fluid bottom: Munk's law, or its 31 samples, as a
/// measured profile would be, under a rule of interpolation. \param law  "munk" or a rule's name
inline Environment deep_ocean(std::string_view law) {
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  Environment ocean{.water = munk};
  ocean.bottom = {.depth = 5395.0, .material = FluidHalfSpace{}};
  ocean.absorption = Thorp{};
  const std::vector<double> depth = {
      0,   10,  20,   30,   50,   75,   100,  125,  150,  200,  250,  300,  400,  500,  600, 700,
      800, 900, 1000, 1100, 1200, 1300, 1500, 2000, 2500, 3000, 3500, 4000, 4500, 5000, 5500};
  std::vector<double> speed;
  for (const double z : depth) speed.push_back(munk.at(z).c);
  for (const Interpolation rule :
       {Interpolation::c_linear, Interpolation::n2_linear, Interpolation::spline,
        Interpolation::pchip, Interpolation::pchip_spline_slopes})
    if (name(rule) == law) ocean.water = SoundSpeedProfile::table(depth, speed, rule);
  return ocean;
}

/// Munk's profile in so many layers of one gradient each, 5000 m deep.
inline Environment munk_in_layers(int layers) {
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  std::vector<double> depth, speed;
  for (int i = 0; i <= layers; ++i) {
    depth.push_back(5000.0 * i / layers);
    speed.push_back(munk.at(depth.back()).c);
  }
  Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear)};
  ocean.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  return ocean;
}

}  // namespace asdic::detail::support
