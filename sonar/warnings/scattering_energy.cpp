#include <cstdio>

#include "raytrace/ocean/roughness.h"
#include "sonar/warnings/warnings.h"

namespace asdic::checks {
namespace {

/// The greatest share of a law between grazing angles of 1 and 60°, and where.
std::string of_law(const char* where, const ScatteredElsewhere& law) {
  double most = 1.0, at = 0.0;
  for (int angle = 1; angle <= 60; ++angle)
    for (const double k : law.wavenumbers)
      if (const double share = law.at(radians(angle), k); share > most) most = share, at = angle;
  if (most <= 1.0) return "";
  char text[200];
  std::snprintf(text, sizeof text,
                "%s: at %.0f degrees the law scatters %.2f times the energy that comes in; what is "
                "reflected there gives way, the rest is too much",
                where, at, most);
  return text;
}

}  // namespace

std::string scattering_energy(const Scenario& scenario) {
  const Environment& ocean = scenario.environment;
  std::string text = of_law("reverberation.surface", ocean.surface.roughness.elsewhere);
  return text.empty() ? of_law("reverberation.bottom", ocean.bottom.roughness.elsewhere) : text;
}

}  // namespace asdic::checks
