#include "raytrace/beams/fan.h"

#include <algorithm>
#include <cmath>

namespace asdic {

BeamFan even_fan(double lowest, double highest, int count) {
  const double width = highest - lowest;
  const bool circle = std::abs(width - 2.0 * pi) < 1e-9;
  const int n = std::max(count, 2);
  BeamFan fan{.spacing = width / (circle ? n : n - 1)};
  fan.elevation.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) fan.elevation.push_back(lowest + i * fan.spacing);
  if (!circle) fan.elevation.back() = highest;
  return fan;
}

BeamFan given_fan(const std::vector<double>& elevations) {
  BeamFan fan{.elevation = elevations};
  std::sort(fan.elevation.begin(), fan.elevation.end());
  fan.spacing = (fan.elevation.back() - fan.elevation.front()) /
                static_cast<double>(fan.elevation.size() - 1);
  return fan;
}

double launch_amplitude(const PropagationCase& run_case, double source_depth, double source_speed,
                        double elevation) noexcept {
  const BeamSettings& beams = run_case.beams;
  double amplitude = beams.pattern ? std::abs(beams.pattern->at(elevation)) : 1.0;
  if (run_case.field == FieldKind::semi_coherent) {
    const double k = 2.0 * pi * run_case.frequency / source_speed;
    amplitude *= std::sqrt(2.0) * std::abs(std::sin(k * source_depth * std::sin(elevation)));
  }
  return amplitude;
}

}  // namespace asdic
