#include "reverb/patches.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace asdic {

std::vector<Patch> patches(const GroundPaths& ground, const AnySurfaceScattering& scattering,
                           double frequency, std::span<const CellTilt> tilt) {
  constexpr double weakest = 1e-4;  // −80 dB of a cell's strongest pair
  std::vector<Patch> found;
  for (std::size_t cell = 0; cell < ground.cells(); ++cell) {
    const auto paths = ground.paths(cell);
    if (paths.empty()) continue;
    const double range = ground.range(cell);
    const double area =
        2.0 * pi * range * ground.spacing() * (tilt.empty() ? 1.0 : tilt[cell].area);
    const auto grazing = [&](const GroundPath& path) {
      if (tilt.empty()) return path.grazing;
      return std::asin(std::min(1.0, std::sin(path.grazing) * tilt[cell].grazing));
    };
    const auto begin = found.size();
    double strongest = 0.0;
    for (std::size_t out = 0; out < paths.size(); ++out) {
      for (std::size_t back = 0; back <= out; ++back) {  // σ is reciprocal: (a, b) serves (b, a)
        const GroundPath &a = paths[out], &b = paths[back];
        const double sigma = scattering_cross_section(
            scattering, {.grazing_in = grazing(a), .grazing_out = grazing(b), .azimuth = pi},
            frequency);
        const std::complex<double> amplitude = a.amplitude * b.amplitude * std::sqrt(sigma * area);
        strongest = std::max(strongest, std::abs(amplitude));
        const auto add = [&](const GroundPath& there, const GroundPath& home) {
          found.push_back({.cell = static_cast<std::uint32_t>(cell),
                           .range = range,
                           .area = area,
                           .delay = there.delay + home.delay,
                           .amplitude = amplitude,
                           .cross_section = sigma,
                           .grazing_in = grazing(there),
                           .grazing_out = grazing(home),
                           .launch_elevation = there.launch_elevation,
                           .return_elevation = home.launch_elevation,
                           .outgoing_slowness = there.horizontal_slowness,
                           .returning_slowness = home.horizontal_slowness});
        };
        add(a, b);
        if (out != back) add(b, a);
      }
    }
    const auto faint = std::remove_if(
        found.begin() + static_cast<std::ptrdiff_t>(begin), found.end(),
        [&](const Patch& p) { return std::abs(p.amplitude) <= weakest * strongest; });
    found.erase(faint, found.end());
  }
  return found;
}

double ground_spacing(double bandwidth_40db, double surface_sound_speed) noexcept {
  return surface_sound_speed / (4.0 * bandwidth_40db);  // delay 2Δr/c = 1/(2B)
}

}  // namespace asdic
