// Sound that is heard as plane waves by an array that is too long or too bent for them.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "sonar/phone_groups.h"
#include "sonar/transmission.h"
#include "sonar/warnings/warnings.h"

namespace asdic::checks {
namespace {

const ReceiverArray& array_of(const Scenario& scenario, int array) {
  return scenario.arrays[static_cast<std::size_t>(array)];
}

/// How far phones get from where they were at a ping, seen from their middle, until the end of its
/// record [m].
double bent_by(const Scenario& scenario, int array, int ping, double time) {
  const PingSchedule& pings = scenario.pings;
  const double end = time + pings.recording_start + pings.recording_duration;
  const std::vector<Vec3> before = phones_at(scenario, array, ping, time),
                          after = phones_at(scenario, array, ping, end);
  double most = 0.0;
  for (std::size_t n = 0; n < before.size(); ++n)
    most = std::max(most, (after[n] - before[n]).norm());
  return most;
}

/// Whether a sea that stays and forgets from ping to ping scatters: one that a covariance serves.
bool has_still_sea(const ReverberationSettings& sea) {
  const auto still = [](const ScattererField& field) {
    return field.motion.kind == ScattererMotion::Kind::still && field.motion.current.isZero() &&
           field.statistics.coherence_time == 0.0 && !field.statistics.k_shape;
  };
  return (sea.surface_scatters && still(sea.surface_field)) ||
         (sea.bottom && still(sea.bottom_field)) ||
         std::any_of(sea.volume.begin(), sea.volume.end(),
                     [&](const VolumeLayer& layer) { return still(layer.field); });
}

}  // namespace

std::string reverberation_plane_waves(const Scenario& scenario) {
  const ReverberationSettings& sea = scenario.reverberation;
  // Elsewhere groups of phones hear it by themselves.
  if (!sea.enabled || sea.synthesis == ScattererSynthesis::scatterers ||
      scenario.arrays.size() != 1 || scenario.propagation.exact_per_phone || !has_still_sea(sea))
    return "";
  const Listening here{.scenario = scenario};
  const Kinematics hears = array_at(scenario, 0, 0.0);
  if (array_of(scenario, 0).phones.size() < 2 || !hears.velocity.isZero()) return "";
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const int sender = static_cast<int>(t);
    const Carried point = reverberation_point(scenario, sender, 0, 1, 0.0);
    if (point.at(0.0).position != transmitter_at(scenario, sender, 0.0).position) continue;
    const Front front = nearest_reverberation(here, sender, pulse_of(scenario, sender).duration,
                                              pulse_frequencies(scenario).highest);
    const double error = one_group(here, front, point).error;
    if (error <= reverberation_periods) continue;
    const double far = front.length * error / reverberation_periods;
    char text[320];
    std::snprintf(text, sizeof text,
                  "reverberation.synthesis: where it is drawn from its covariance, it is plane "
                  "waves for array %s: the first are up to %.2g periods off at its ends, 1/16 "
                  "after %.2g s; with \"scatterers\" or propagation.exact_per_phone = true they "
                  "are not",
                  array_of(scenario, 0).name.c_str(), error,
                  2.0 * far / speed_at(scenario, hears.position));
    return text;
  }
  return "";
}

std::string noise_of_a_bent_line(const Scenario& scenario) {
  if (!scenario.noise.any() || scenario.noise.coherence == NoiseCoherence::independent) return "";
  const double highest = pulse_frequencies(scenario).highest;
  for (std::size_t a = 0; a < scenario.arrays.size(); ++a) {
    const int array = static_cast<int>(a);
    if (!deforms(scenario, array)) continue;
    const std::vector<Transmission> sent = transmissions(scenario);
    constexpr std::size_t looked_at = 100;
    const std::size_t step = (sent.size() + looked_at - 1) / looked_at;
    double bent = 0.0;
    for (std::size_t i = 0; i < sent.size(); i += step)
      bent = std::max(bent, bent_by(scenario, array, static_cast<int>(i) + 1, sent[i].time));
    const double c = speed_at(scenario, array_at(scenario, array, 0.0).position);
    const double periods = bent * highest / c;
    if (periods <= reverberation_periods) continue;
    char text[256];
    std::snprintf(text, sizeof text,
                  "noise.coherence: array %s turns and bends by up to %.3g m while a ping is "
                  "heard, and its noise keeps the shape at the ping: up to %.2g periods off at "
                  "%g Hz",
                  array_of(scenario, array).name.c_str(), bent, periods, highest);
    return text;
  }
  return "";
}

}  // namespace asdic::checks
