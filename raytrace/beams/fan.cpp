#include "raytrace/beams/fan.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

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

BeamFan fan_between(const BeamFan& even) {
  const auto n = static_cast<double>(even.elevation.size());
  const bool circle = std::abs(n * even.spacing - 2.0 * pi) < 1e-9;
  BeamFan fan{.elevation = even.elevation, .spacing = 0.5 * even.spacing};
  if (!circle) fan.elevation.pop_back();
  for (double& elevation : fan.elevation) elevation += fan.spacing;
  return fan;
}

BeamFan graded_fan(const BeamFan& fan, const std::vector<double>& share, std::size_t count,
                   const FinestTubes& finest) {
  constexpr double most_parts = 8.0;
  std::vector<double> most(share.size(), most_parts);  // of each tube
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double from = fan.elevation[i], to = fan.elevation[i + 1];
    const bool level = from < finest.level && to > -finest.level;
    const double least = level ? std::max(finest.level, finest.width) : finest.width;
    if (least > 0.0) most[i] = std::clamp(std::floor((to - from) / least), 1.0, most_parts);
  }
  const auto parts = [&](double scale, std::size_t i) {
    return std::clamp(std::floor(scale * std::sqrt(share[i])), 1.0, most[i]);
  };
  const auto beams = [&](double scale) {
    double n = 1.0;
    for (std::size_t i = 0; i < share.size(); ++i) n += parts(scale, i);
    return n;
  };
  double all = 1.0;
  for (std::size_t i = 0; i < share.size(); ++i) all += share[i] > 0.0 ? most[i] : 1.0;
  const double wanted = std::min(static_cast<double>(count), all);
  const double largest = share.empty() ? 0.0 : *std::max_element(share.begin(), share.end());
  double low = 0.0, high = largest > 0.0 ? 1.0 / std::sqrt(largest) : 0.0;
  for (int i = 0; i < 60 && beams(high) < wanted; ++i) low = high, high *= 2.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (beams(middle) < wanted ? low : high) = middle;
  }
  BeamFan result{.spacing = fan.spacing, .graded = true};
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double from = fan.elevation[i], width = fan.elevation[i + 1] - from;
    const auto n = static_cast<int>(parts(high, i));
    for (int k = 0; k < n; ++k) result.elevation.push_back(from + width * k / n);
  }
  result.elevation.push_back(fan.elevation.back());
  return result;
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
    const double sine = std::abs(std::sin(elevation));
    const RoughReflection left = rough_reflection(run_case.environment.surface.roughness, sine, k);
    // 1 + E − 2m cos 2φ of the pair, shared as 1 : E. Of a mirror 2 sin²φ
    const double mirrored = 2.0 * left.coherent / (1.0 + left.energy),
                 lloyd = std::sin(k * source_depth * sine);
    amplitude *= std::sqrt(1.0 - mirrored + 2.0 * mirrored * lloyd * lloyd);
  }
  return amplitude;
}

}  // namespace asdic::detail
