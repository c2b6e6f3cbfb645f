// Sound that is received as plane waves by an array that is too long or too bent for them.
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "sonar/noise/ambient_noise.h"
#include "sonar/noise/noise_coherence.h"
#include "sonar/noise/noise_in_guide.h"
#include "sonar/reverberation/phone_groups.h"
#include "sonar/scenario/transmission.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

const ReceiverArray& array_of(const Scenario& scenario, int array) {
  return scenario.arrays[static_cast<std::size_t>(array)];
}

/// How far phones get from where they are at a time, seen from their middle [m].
double bent_by(const Scenario& scenario, int array, double time, double later) {
  const std::vector<Vec3> before = phones_at(scenario, array, 1, time),
                          after = phones_at(scenario, array, 1, time + later);
  double most = 0.0;
  for (std::size_t n = 0; n < before.size(); ++n)
    most = std::max(most, (after[n] - before[n]).norm());
  return most;
}

/// By how much the coherence of any two phones changes meanwhile: of neighbours, and of some
/// others.
double coherence_change(const Scenario& scenario, int array, double time, double later,
                        double wavenumber, const NoiseField& noise) {
  const std::vector<Vec3> before = phones_at(scenario, array, 1, time),
                          after = phones_at(scenario, array, 1, time + later);
  constexpr std::size_t looked_at = 16;  // each with as many
  const std::size_t step = (before.size() + looked_at - 1) / looked_at;
  double most = 0.0;
  const auto look = [&](std::size_t a, std::size_t b) {
    const auto of = [&](const std::vector<Vec3>& shape) {
      return noise_coherence(noise.coherence, noise.directions, shape[a] - shape[b], wavenumber);
    };
    most = std::max(most, std::abs(of(after) - of(before)));
  };
  for (std::size_t a = 1; a < before.size(); ++a) look(a, a - 1);
  for (std::size_t a = 0; a < before.size(); a += step)
    for (std::size_t b = 0; b < a; b += step) look(a, b);
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
  // Elsewhere streams have round fronts, and groups of phones receive scatterers by themselves.
  if (!sea.enabled || sea.synthesis != ScattererSynthesis::covariance ||
      scenario.arrays.size() != 1 || scenario.propagation.exact_per_phone || !has_still_sea(sea))
    return "";
  const Kinematics receives = array_at(scenario, 0, 0.0);
  if (array_of(scenario, 0).phones.size() < 2 || !receives.velocity.isZero()) return "";
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const PingGeometry geometry(scenario, {.transmitter = static_cast<int>(t)}, 1);
    const PulseFrequencies band = pulse_frequencies(scenario);
    const Carried point = geometry.reverberation_point(0, 0.5 * (band.lowest + band.highest));
    if (point.at(0.0).position != geometry.source().position) continue;
    const double duration = pulse_of(scenario, static_cast<int>(t)).duration;
    const Front front = nearest_reverberation(geometry, 0, duration, band.highest);
    const double error = one_group(listening(geometry, 0), front, point).error;
    if (error <= reverberation_periods) continue;
    const double far = front.length * error / reverberation_periods;
    char text[320];
    std::snprintf(text, sizeof text,
                  "reverberation.synthesis: drawn from its covariance, it is plane waves for array "
                  "%s: the first are up to %.2g periods off at its ends, 1/16 after %.2g s; with "
                  "\"automatic\" they are not",
                  array_of(scenario, 0).name.c_str(), error,
                  2.0 * far / speed_at(scenario, receives.position));
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
    // Half of a block's power lies within a quarter of it from its middle.
    const double block = noise_block(scenario, array), quarter = 0.25 * block;
    const PingSchedule& pings = scenario.pings;
    const std::vector<Transmission> sent = transmissions(scenario);
    constexpr std::size_t looked_at = 100, times = 1000, closely = 4;
    const std::size_t step = (sent.size() + looked_at - 1) / looked_at;
    const std::size_t each =
        std::clamp<std::size_t>(static_cast<std::size_t>(pings.recording_duration / quarter), 1,
                                std::max<std::size_t>(times * step / sent.size(), 8));
    std::vector<std::pair<double, double>> bent;  // by how much, when
    for (std::size_t i = 0; i < sent.size(); i += step)
      for (std::size_t k = 0; k < each; ++k) {
        const double time = sent[i].time + pings.recording_start +
                            pings.recording_duration * double(k) / double(each);
        bent.emplace_back(bent_by(scenario, array, time, quarter), time);
      }
    std::sort(bent.rbegin(), bent.rend());
    const double c = speed_at(scenario, array_at(scenario, array, 0.0).position);
    const NoiseField field = noise_field(scenario, array);
    double change = 0.0;
    for (std::size_t i = 0; i < std::min(closely, bent.size()) && bent[i].first > 0.0; ++i)
      change = std::max(change, coherence_change(scenario, array, bent[i].second, quarter,
                                                 2.0 * pi * highest / c, field));
    constexpr double received = 0.1;
    if (change <= received) continue;
    char text[256];
    std::snprintf(text, sizeof text,
                  "noise.coherence: array %s turns, and in each block of %.2g s its noise has the "
                  "shape of the block's middle: the coherence of two phones changes by up to %.2g "
                  "at %g Hz meanwhile",
                  array_of(scenario, array).name.c_str(), block, change, highest);
    return text;
  }
  return "";
}

}  // namespace asdic::detail::checks
