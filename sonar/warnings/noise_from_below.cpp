#include <algorithm>
#include <cmath>
#include <cstdio>

#include "raytrace/environment.h"
#include "sonar/warnings/warnings.h"

namespace asdic::checks {

std::string noise_from_below(const Scenario& scenario) {
  constexpr double heard = 0.1;  // of what comes down
  if (!scenario.noise.any() || scenario.noise.coherence != NoiseCoherence::surface) return "";
  const Environment& ocean = scenario.environment;
  const double depth = ocean.bottom.depth_at(0.0);
  const WaterAtBoundary water{.speed = sound_speed(ocean, 0.0, depth).c,
                              .density = ocean.water_density.at(depth),
                              .frequency = pulse_frequencies(scenario).lowest};
  double most = 0.0, at = 0.0;
  for (const double angle : {10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0}) {
    const double power =
        std::norm(reflection_coefficient(ocean.bottom.material_at(0.0), radians(angle), water));
    if (power > most) most = power, at = angle;
  }
  if (most < heard) return "";
  char text[240];
  std::snprintf(
      text, sizeof text,
      "noise.coherence: \"surface\" is the sheet of sources above alone; what the bottom "
      "sends up again, %.2g dB of it at %.0f degrees, is left out; a level over elevation "
      "(\"profile\") can hold it",
      db_from_power(most), at);
  return text;
}

}  // namespace asdic::checks
