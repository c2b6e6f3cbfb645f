#include "sonar/echoes/sparse_sound.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "raytrace/ocean/absorption.h"
#include "sonar/echoes/wave_response.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail {
namespace {

/// What an echo's legs that are no rays do across the band.
struct PathWaves {
  double ray_length = 0.0;  ///< of the legs that are rays [m]
  std::vector<std::shared_ptr<const SampledResponse>> legs;

  [[nodiscard]] std::complex<double> at(double frequency) const {
    std::complex<double> product = 1.0;
    for (const auto& leg : legs) product *= leg->at(frequency);
    return product;
  }
  /// Of the polynomial that the product is.
  [[nodiscard]] std::size_t degree() const {
    std::size_t sum = 0;
    for (const auto& leg : legs) sum += leg->values.size() - 1;
    return sum;
  }
};

/// Of every path; a leg that several share is computed once. \return [paths]
std::vector<PathWaves> waves_of(const EchoContext& context, std::span<const EchoPath> paths,
                                std::span<const Leg> legs, double centre, double half_band) {
  std::vector<std::pair<ExactKey, std::shared_ptr<const SampledResponse>>> known;
  std::vector<PathWaves> all;
  for (const EchoPath& path : paths) {
    PathWaves& waves =
        all.emplace_back(PathWaves{.ray_length = path.response.path_length, .legs = {}});
    for (const WaveLeg& leg : wave_legs(context, path, legs)) {
      waves.ray_length -= leg.path.path_length;
      ExactKey key = context.paths.key(Kept::legs, leg.from, leg.to, leg.limits, leg.path.delay);
      add_path(key, leg.path);
      auto found = std::find_if(known.begin(), known.end(),
                                [&](const auto& one) { return one.first == key; });
      if (found == known.end())
        found = known.insert(known.end(),
                             {std::move(key), std::make_shared<SampledResponse>(wave_response(
                                                  context.paths, leg, centre, half_band))});
      waves.legs.push_back(found->second);
    }
  }
  return all;
}

}  // namespace

PulseBand::PulseBand(const EchoContext& context, const Transmitter& projector,
                     const Recording& recording, double max_doppler)
    : water_(context.paths.along_transect().environment().absorption),
      projector_(projector),
      centre_(context.pulse->centre_frequency()),
      half_band_(
          Synthesizer(*context.pulse, recording, max_doppler, context.paths.memory()).half_band()),
      sound_speed_(context.paths.speed_at(context.geometry.source().position)),
      heading_(context.geometry.source_heading()) {}

double PulseBand::nepers_per_metre(double frequency) const {
  return absorption_db_per_km(water_, frequency) / 1000.0 * std::numbers::ln10 / 20.0;
}

BeamPattern PulseBand::pattern_at(double frequency) const {
  return {projector_, sound_speed_ / frequency, sound_speed_, heading_, sound_speed_ / centre_};
}

BandNodes PulseBand::nodes(double longest) const {
  const double lowest = std::max(1.0, centre_ - half_band_);
  const double nepers =
      0.5 * longest * std::abs(nepers_per_metre(centre_ + half_band_) - nepers_per_metre(lowest));
  return band_nodes(centre_, half_band_, nepers, pattern_at(centre_).longest_delay());
}

BandPart PulseBand::part(const BandNodes& nodes, std::size_t k) const {
  const double f = std::max(1.0, nodes.frequencies[k]);
  return {.filter = [nodes, k,
                     centre = centre_](double beside) { return nodes.basis(k, centre + beside); },
          .pattern = pattern_at(f),
          .more_nepers_per_metre = nepers_per_metre(f) - nepers_per_metre(centre_)};
}

Baseband narrow_band_sound(const Synthesizer& synthesizer, std::span<const EchoPath> paths,
                           std::span<const Vec3> phones) {
  Returns straight;
  std::vector<CurvedReturn> curved;
  for (const EchoPath& path : paths)
    if (path.curve)
      curved.push_back({path.received, *path.curve});
    else
      straight.push_back(path.received);
  // Of a part of a record that holds no echo: the transforms of nothing take time as well.
  Baseband sound = straight.empty() ? synthesizer.silence(phones.size())
                                    : synthesizer.baseband(straight, phones);
  synthesizer.add_curved(curved, phones, sound);
  return sound;
}

std::vector<SoundOfBand> across_band(const EchoContext& context, const Transmitter& projector,
                                     std::span<const EchoPath> paths, std::span<const Leg> legs,
                                     const Recording& recording, double max_doppler) {
  const PulseBand of_pulse(context, projector, recording, max_doppler);
  const double centre = of_pulse.centre(), half_band = of_pulse.half_width();
  double longest = 0.0;
  for (const EchoPath& path : paths) longest = std::max(longest, path.response.path_length);
  BandNodes band = of_pulse.nodes(longest);
  const std::vector<PathWaves> waves = waves_of(context, paths, legs, centre, half_band);
  std::size_t of_waves = 0;
  for (const PathWaves& path : waves) of_waves = std::max(of_waves, path.degree());
  if (of_waves > 0) band = chebyshev_nodes(centre, half_band, band.frequencies.size() + of_waves);

  std::vector<SoundOfBand> all;
  for (std::size_t k = 0; k < band.frequencies.size(); ++k) {
    const double f = std::max(1.0, band.frequencies[k]);
    SoundOfBand& sound = all.emplace_back(SoundOfBand{of_pulse.part(band, k), {}});
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const PathResponse& response = paths[i].response;
      sound.amplitudes.push_back(response.without_pattern *
                                 sound.part.pattern.towards(response.bearing, response.elevation) *
                                 std::exp(-sound.part.more_nepers_per_metre * waves[i].ray_length) *
                                 waves[i].at(f));
    }
  }
  return all;
}

Baseband wide_band_sound(const EchoContext& context, const Transmitter& projector,
                         std::span<const EchoPath> paths, std::span<const Leg> legs,
                         std::span<const Vec3> phones, const Recording& recording,
                         double max_doppler) {
  Baseband all;
  std::vector<EchoPath> filtered(paths.begin(), paths.end());
  for (const SoundOfBand& one :
       across_band(context, projector, paths, legs, recording, max_doppler)) {
    for (std::size_t i = 0; i < filtered.size(); ++i)
      filtered[i].received.amplitude = one.amplitudes[i];
    Baseband sound = narrow_band_sound(
        Synthesizer(*context.pulse, recording, max_doppler, one.part.filter), filtered, phones);
    if (all.channels == 0)
      all = std::move(sound);
    else
      std::transform(sound.values.begin(), sound.values.end(), all.values.begin(),
                     all.values.begin(), std::plus<>{});
  }
  return all;
}

}  // namespace asdic::detail
