#include "sonar/noise/noise_in_guide.h"

#include <algorithm>
#include <cmath>

#include "raytrace/ocean/environment.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {
namespace {

constexpr double least_level_db = -150.0;  // of what no ray brings
constexpr double least_loss = 1e-4;        // of a cycle: without any there would be no end of it

WaterAtBoundary beside(const Environment& ocean, const Boundary& wall, double frequency) {
  const double depth = wall.depth_at(0.0);
  return {.speed = sound_speed(ocean, 0.0, depth).c,
          .density = ocean.water_density.at(depth),
          .frequency = frequency};
}

/// |R|² of a wall at a grazing angle, with what a rough one scatters forward.
double reflected_power(const Environment& ocean, const Boundary& wall, double grazing,
                       double frequency) {
  const WaterAtBoundary water = beside(ocean, wall, frequency);
  return std::norm(reflection_coefficient(wall.material_at(0.0), grazing, water)) *
         rough_reflection(wall.roughness, std::sin(grazing), 2.0 * pi * frequency / water.speed)
             .energy;
}

/// Rays through the phones' depth.
class NoiseRays {
 public:
  NoiseRays(const Environment& ocean, double depth, double dipole_exponent, double frequency)
      : ocean_(ocean),
        dipole_exponent_(dipole_exponent),
        frequency_(frequency),
        speed_(sound_speed(ocean, 0.0, depth).c),
        above_(layers(ocean.surface.depth, depth)),
        below_(layers(depth, ocean.bottom.depth)) {}

  /// w at an elevation [rad], up to a constant.
  [[nodiscard]] double at(double elevation) const {
    const double slowness = std::cos(elevation) / speed_;
    const Way up = way(above_, slowness);
    if (!up.through) return 0.0;
    const Way down = way(below_, slowness);
    const double surface = grazing_at(ocean_.surface, slowness);
    const double sent_back =
        (down.through ? reflected_power(ocean_, ocean_.bottom, grazing_at(ocean_.bottom, slowness),
                                        frequency_)
                      : 1.0) *
        std::exp(-4.0 * down.nepers);
    const double cycle = sent_back * std::exp(-4.0 * up.nepers) *
                         reflected_power(ocean_, ocean_.surface, surface, frequency_);
    const double above = std::pow(std::sin(surface), 2.0 * dipole_exponent_ - 1.0) *
                         std::exp(-2.0 * up.nepers) / std::max(1.0 - cycle, least_loss);
    return elevation < 0.0 ? above * sent_back : above;
  }
  [[nodiscard]] double level_db(double elevation) const {
    return std::max(db_from_power(std::max(at(elevation), 1e-300)), least_level_db);
  }

 private:
  struct Layer {
    double speed, thickness, nepers_per_metre;
  };
  struct Way {
    bool through = true;
    double nepers = 0.0;  // ∫α ds to the far side or the turn
  };
  [[nodiscard]] std::vector<Layer> layers(double from, double to) const {
    constexpr int count = 400;
    const DepthFunction loss = attenuation_np_per_m(ocean_, frequency_);
    std::vector<Layer> all;
    for (int i = 0; i < count && to > from; ++i) {
      const double z = from + (to - from) * (i + 0.5) / count;
      all.push_back({sound_speed(ocean_, 0.0, z).c, (to - from) / count, loss.at(z)});
    }
    return all;
  }
  [[nodiscard]] Way way(const std::vector<Layer>& through, double slowness) const {
    Way found;
    for (const Layer& layer : through) {
      const double cosine = slowness * layer.speed;
      if (cosine >= 1.0) found.through = false;
    }
    for (std::size_t i = 0; i < through.size(); ++i) {
      // from the phones outwards
      const Layer& layer = &through == &above_ ? through[through.size() - 1 - i] : through[i];
      const double cosine = slowness * layer.speed;
      if (cosine >= 1.0) break;
      found.nepers +=
          layer.nepers_per_metre * layer.thickness / std::sqrt((1.0 - cosine) * (1.0 + cosine));
    }
    return found;
  }
  [[nodiscard]] double grazing_at(const Boundary& wall, double slowness) const {
    const double cosine = slowness * sound_speed(ocean_, 0.0, wall.depth).c;
    return std::acos(std::min(cosine, 1.0));
  }

  const Environment& ocean_;
  double dipole_exponent_, frequency_, speed_;
  std::vector<Layer> above_, below_;
};

}  // namespace

NoiseDirections surface_noise(const Environment& ocean, double depth, double dipole_exponent,
                              double frequency) {
  constexpr double straight_db = 0.1, narrowest = radians(0.1);
  const NoiseRays rays(ocean, depth, dipole_exponent, frequency);
  NoiseDirections found;
  found.dipole_exponent = dipole_exponent;
  const auto add = [&](double elevation, double level) {
    found.elevation.push_back(elevation);
    found.level_db.push_back(level);
  };
  /// What lies between two elevations, and the second.
  const auto between = [&](auto&& self, double a, double a_db, double b, double b_db) -> void {
    const double middle = 0.5 * (a + b), level = rays.level_db(middle);
    if (b - a > narrowest && std::abs(level - 0.5 * (a_db + b_db)) > straight_db) {
      self(self, a, a_db, middle, level);
      self(self, middle, level, b, b_db);
      return;
    }
    add(b, b_db);
  };
  constexpr int segments = 18;  // on either side; the horizontal belongs to both
  for (const double side : {-1.0, 1.0}) {
    const double least = side < 0.0 ? -0.5 * pi : 0.5 * narrowest,
                 most = side < 0.0 ? -0.5 * narrowest : 0.5 * pi;
    double from = least, from_db = rays.level_db(from);
    add(from, from_db);
    for (int i = 1; i <= segments; ++i) {
      const double to = std::lerp(least, most, double(i) / segments), to_db = rays.level_db(to);
      between(between, from, from_db, to, to_db);
      from = to, from_db = to_db;
    }
  }
  return found;
}

SentUp sent_up(const Environment& ocean, double frequency) {
  SentUp most;
  for (const double angle : {10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0}) {
    const double share = reflected_power(ocean, ocean.bottom, radians(angle), frequency);
    if (share > most.share) most = {share, radians(angle)};
  }
  return most;
}

NoiseField noise_field(const Scenario& scenario, int array) {
  const NoiseSettings& asked = scenario.noise;
  NoiseField field{asked.coherence, asked.directions};
  if (!asked.any() || asked.coherence != NoiseCoherence::surface || ocean_on_map(scenario).varies())
    return field;
  const double frequency = Pulse(pulse_of(scenario, 0)).centre_frequency();
  constexpr double received = 1e-3;
  if (sent_up(scenario.environment, frequency).share < received) return field;
  return {NoiseCoherence::profile,
          surface_noise(scenario.environment, ArrayMotion(scenario, array).at(0.0).position.z(),
                        asked.directions.dipole_exponent, frequency)};
}

}  // namespace asdic::detail
