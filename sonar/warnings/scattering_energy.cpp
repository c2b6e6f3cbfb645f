#include <cstdio>

#include "reverb/scattering/energy.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

/// The greatest share of a law, in all directions, at some grazing angles and where.
template <class... Law>
std::string of_law(const char* where, const std::variant<Law...>& law, double lowest,
                   double highest) {
  double most = 1.0, at = 0.0;
  for (const double angle : {2.0, 5.0, 10.0, 20.0, 40.0, 60.0})
    for (const double frequency : {lowest, highest}) {
      const double share = std::visit(
          [&](const auto& model) { return scattered_share(model, radians(angle), frequency); },
          law);
      if (share > most) most = share, at = angle;
    }
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
  const ReverberationSettings& reverberation = scenario.reverberation;
  const Environment& ocean = scenario.environment;
  if (!reverberation.enabled) return "";
  const auto [lowest, highest] = pulse_frequencies(scenario);
  std::string text;
  if (reverberation.surface_scatters && ocean.surface.roughness.rms_height > 0.0)
    text = of_law("reverberation.surface", reverberation.surface, lowest, highest);
  if (text.empty() && reverberation.bottom && ocean.bottom.roughness.rms_height > 0.0)
    text = of_law("reverberation.bottom", *reverberation.bottom, lowest, highest);
  return text;
}

}  // namespace asdic::detail::checks
