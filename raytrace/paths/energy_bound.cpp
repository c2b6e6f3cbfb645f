#include "raytrace/paths/energy_bound.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/ocean/speed_extremes.h"

namespace asdic::detail {
namespace {

constexpr double margin = 64.0;

double intensity(const Arrival& path) { return std::norm(path.amplitude) + path.scattered; }

double intensity(const Arrivals& paths) {
  double sum = 0.0;
  for (const Arrival& path : paths) sum += intensity(path);
  return sum;
}

double squared_distance(const LegEnds& ends) {
  const double deeper = ends.receiver_depth - ends.source_depth;
  return ends.range * ends.range + deeper * deeper;
}

/// sin² of the angle, at the slowest depth, of the steepest wave that the water turns.
double steepest_sine2(const Environment& ocean) noexcept {
  const auto [slow, fast] = speed_extremes(ocean.water, ocean.surface.depth, ocean.bottom.depth);
  return (1.0 - slow / fast) * (1.0 + slow / fast);
}

[[noreturn]] void tell(const Arrivals& paths, const Environment& ocean, const LegEnds& ends) {
  const auto loudest =
      std::max_element(paths.begin(), paths.end(), [](const Arrival& a, const Arrival& b) {
        return intensity(a) < intensity(b) ||
               (!std::isnan(intensity(a)) && std::isnan(intensity(b)));
      });
  const double d2 = squared_distance(ends), sum = intensity(paths);
  char text[512];
  std::snprintf(
      text, sizeof text,
      "a path louder than energy allows, which is a fault of this program: %.6g Hz, %.6g m at "
      "depths of %.6g and %.6g m, all %zu paths together %.1f dB over spherical spreading, at most "
      "%.1f dB are possible; the loudest, launched at %.4g deg with %d surface and %d bottom "
      "bounces after %.6g s, has %.1f dB, and %.1f dB scattered, re 1 m",
      ends.frequency, ends.range, ends.source_depth, ends.receiver_depth, paths.size(),
      db_from_power(sum * d2), db_from_power(most_intensity(ocean, ends) * d2),
      degrees(loudest->launch_elevation), loudest->surface_bounces, loudest->bottom_bounces,
      loudest->delay, db_from_power(std::norm(loudest->amplitude)),
      db_from_power(loudest->scattered));
  throw RunError(text);
}

}  // namespace

double most_intensity(const Environment& ocean, const LegEnds& ends) noexcept {
  const double d = std::hypot(ends.range, ends.receiver_depth - ends.source_depth);
  const double k = 2.0 * pi * ends.frequency / sound_speed(ocean, 0.0, ends.source_depth).c;
  const double half_wave = pi / k;
  const double thickness =
      ends.layered ? std::max(ocean.bottom.depth - ocean.surface.depth, half_wave) : half_wave;
  const double sine2 = ends.layered ? steepest_sine2(ocean) : 1.0;
  const double gain = 1.0 + 8.0 / pi * k * d * sine2 + pi * d / thickness;
  return margin / (d * d) * (ends.in_volume ? gain * gain : gain);
}

double excess(const Arrivals& paths, const Environment& ocean, const LegEnds& ends) {
  const double sum = intensity(paths), d2 = squared_distance(ends);
  // Few legs are so much louder than spherical spreading that the bound itself is needed.
  if (!(d2 > 0.0) || sum * d2 <= margin) return 0.0;
  return sum / most_intensity(ocean, ends);
}

void ensure_bounded(const Arrivals& paths, const Environment& ocean, const LegEnds& ends) {
  if (!(excess(paths, ocean, ends) <= 1.0)) tell(paths, ocean, ends);
}

}  // namespace asdic::detail
