#include "sonar/sparse_sound.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "raytrace/ocean/absorption.h"
#include "sonar/transmitter.h"

namespace asdic {

Baseband narrow_band_sound(const Synthesizer& synthesizer, std::span<const EchoPath> paths,
                           std::span<const Vec3> phones) {
  Returns straight;
  std::vector<CurvedReturn> curved;
  for (const EchoPath& path : paths)
    if (path.curve)
      curved.push_back({path.heard, *path.curve});
    else
      straight.push_back(path.heard);
  Baseband sound = synthesizer.baseband(straight, phones);
  synthesizer.add_curved(curved, phones, sound);
  return sound;
}

Baseband wide_band_sound(const EchoContext& context, const Transmitter& projector,
                         std::span<const EchoPath> paths, std::span<const Vec3> phones,
                         const Recording& recording, double max_doppler) {
  const Pulse& pulse = *context.pulse;
  const double centre = pulse.centre_frequency();
  const Absorption& water = context.paths.along_transect().environment().absorption;
  const auto nepers_per_metre = [&](double frequency) {
    return absorption_db_per_km(water, frequency) / 1000.0 * std::numbers::ln10 / 20.0;
  };
  const Kinematics source =
      transmitter_at(context.scenario, context.transmitter, context.ping_time);
  const double c = context.paths.speed_at(source.position);
  const double heading = platform_heading(context.scenario, projector.platform, context.ping_time);
  const auto pattern_at = [&](double frequency) {
    return BeamPattern(projector, c / frequency, c, heading, c / centre);
  };

  const double half_band =
      Synthesizer(pulse, recording, max_doppler, context.paths.memory()).half_band();
  double longest = 0.0;
  for (const EchoPath& path : paths) longest = std::max(longest, path.colour.path_length);
  const double lowest = std::max(1.0, centre - half_band);
  const double nepers =
      0.5 * longest * std::abs(nepers_per_metre(centre + half_band) - nepers_per_metre(lowest));
  const BandNodes band = band_nodes(centre, half_band, nepers, pattern_at(centre).longest_delay());

  Baseband all;
  std::vector<EchoPath> coloured(paths.begin(), paths.end());
  for (std::size_t k = 0; k < band.frequencies.size(); ++k) {
    const double f = std::max(1.0, band.frequencies[k]);
    const BeamPattern pattern = pattern_at(f);
    const double more = nepers_per_metre(f) - nepers_per_metre(centre);
    for (EchoPath& path : coloured)
      path.heard.amplitude = path.colour.without_pattern *
                             pattern.towards(path.colour.bearing, path.colour.elevation) *
                             std::exp(-more * path.colour.path_length);
    const Synthesizer part(pulse, recording, max_doppler,
                           [&](double beside) { return band.basis(k, centre + beside); });
    Baseband sound = narrow_band_sound(part, coloured, phones);
    if (k == 0)
      all = std::move(sound);
    else
      std::transform(sound.values.begin(), sound.values.end(), all.values.begin(),
                     all.values.begin(), std::plus<>{});
  }
  return all;
}

}  // namespace asdic
