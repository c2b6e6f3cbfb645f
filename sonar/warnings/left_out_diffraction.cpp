#include <cmath>
#include <cstdio>

#include "core/geometry.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/places/propagation_paths.h"
#include "raytrace/waves/diffraction.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

/// Where a surface duct ends, and from which frequency on rays in it are right.
struct SurfaceDuct {
  double depth = 0.0;      ///< of the first maximum of the speed [m]; 0: there is none
  double frequency = 0.0;  ///< ten times that of its first mode, c/(2H·√(2Δc/c)) [Hz]
};

SurfaceDuct surface_duct(const Environment& ocean) {
  constexpr int steps = 500;
  const double top = ocean.surface.depth_at(0.0), bottom = ocean.bottom.depth_at(0.0);
  const double at_surface = sound_speed(ocean, 0.0, top).c;
  double fastest = at_surface;
  for (int i = 1; i <= steps; ++i) {
    const double height = (bottom - top) * std::pow(double(i) / steps, 2);
    const double c = sound_speed(ocean, 0.0, top + height).c;
    if (c < fastest && fastest > at_surface) {
      const double duct = (bottom - top) * std::pow((i - 1.0) / steps, 2);
      const double slope = std::sqrt(2.0 * (fastest - at_surface) / fastest);
      return {duct, 10.0 * fastest / (2.0 * duct * slope)};
    }
    if (c < fastest) break;
    fastest = c;
  }
  return {};
}

std::string over_a_transect(const Environment& ocean) {
  std::string text =
      "propagation: where the ocean varies with range rays are all there is: sound in shadows, "
      "beyond caustics and out of ducts is left out";
  const SurfaceDuct duct = surface_duct(ocean);
  if (duct.depth > 0.0) {
    char more[120];
    std::snprintf(more, sizeof more,
                  "; inside the surface duct of about %.2g m they are right from about %.2g Hz on",
                  duct.depth, duct.frequency);
    text += more;
  }
  return text;
}

}  // namespace

std::string left_out_diffraction(const Scenario& scenario) {
  if (!scenario.propagation.diffraction || scenario.targets.empty()) return "";
  const Environment& ocean = scenario.environment;
  if (varies_with_range(ocean)) return over_a_transect(ocean);
  if (!is_layered(ocean))
    return "propagation: where losses vary with depth sound in shadows, beyond caustics and out of "
           "ducts is left out";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const double frequency = 0.5 * (pulse.lowest + pulse.highest);
  const Vec3 source = transmitter_at(scenario, 0, 0.0).position;
  for (const Target& target : scenario.targets) {
    const Vec3 place = target.track.at(0.0).position;
    const double range = separation(source, place).range;
    if (diffraction_is_affordable(ocean, source.z(), place.z(), range, frequency)) continue;
    for (const Arrival& ray : EigenraySolver(ocean).find(source.z(), place.z(), range, frequency,
                                                         limits_of(scenario.propagation)))
      if (ray.bottom_bounces == 0) return "";
    char text[240];
    std::snprintf(text, sizeof text,
                  "propagation: no ray reaches target \"%.60s\" without the bottom, and %.3g Hz "
                  "over %.3g km are too dear for the wave equation: sound out of ducts and into "
                  "shadows is left out",
                  target.name.c_str(), frequency, range / 1000.0);
    return text;
  }
  return "";
}

}  // namespace asdic::detail::checks
