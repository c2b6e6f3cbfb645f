#pragma once
#include <cmath>
#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "reverb/power/reverberation_streams.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/reverberation/reverberation_model.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/synthesis/synthesis.h"
#include "support/thesis.h"

namespace asdic::detail::support {

/// 1500 m/s everywhere, a vehicle at 4500 m, 4 kHz, 220 dB at all bearings, one phone, no bounces:
/// the sea of reverb_isovelocity.csv but for its pulse.
inline Scenario even_sea() {
  Scenario s = thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.transmitters[0].source_level_db = 220.0;
  s.arrays[0].phones = {Vec3::Zero()};
  s.reverberation.enabled = true;
  s.reverberation.azimuths = 12;
  return s;
}

/// That sea without its surface, a pulse of 0.12 s.
inline Scenario quiet_sea() {
  Scenario s = even_sea();
  s.reverberation.surface_scatters = false;
  s.pulse = {.duration = 0.12};
  return s;
}

/// Lambert's law on the bottom alone, heard and lit by itself and by a still surface, which turns
/// the sign (Lloyd's mirror); every ping sees other scatterers. \param mu_db  Mackenzie's
inline Scenario mirrored_floor(double depth, double source_depth, double mu_db,
                               const PulseSettings& pulse) {
  Scenario s = even_sea();
  s.wind_speed = 0.0;
  s.environment.bottom.depth = depth;
  s.platforms[0].track.start.position = {0.0, 0.0, source_depth};
  s.pulse = pulse;
  s.propagation = {};
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 0;
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{.mu_db = mu_db};
  s.reverberation.bottom_field.statistics.coherence_time = 0.0;
  return s;
}

/// The reverberation alone of a scenario's pings, from its first transmitter to its first array.
class ReverberantSea {
 public:
  /// \param pattern  of the transmitter; null: the scenario's vertical line
  explicit ReverberantSea(Scenario s, std::unique_ptr<TransmitPattern> pattern = nullptr)
      : scenario_(std::move(s)),
        paths_(scenario_.environment, scenario_.transect, scenario_.area),
        pulse_(scenario_.pulse),
        pattern_(pattern ? std::move(pattern)
                         : std::make_unique<BeamPattern>(
                               scenario_.transmitters[0],
                               paths_.speed_at(source()) / pulse_.centre_frequency())),
        model_(scenario_, paths_, pulse_),
        synthesizer_(pulse_, recording(), doppler_bound(scenario_)) {}

  [[nodiscard]] const Scenario& scenario() const { return scenario_; }
  [[nodiscard]] const Pulse& pulse() const { return pulse_; }
  [[nodiscard]] double spacing() const { return model_.ground_spacing(); }
  [[nodiscard]] Recording recording() const {
    return {.sample_rate = scenario_.pings.sample_rate,
            .start = scenario_.pings.recording_start,
            .samples = static_cast<std::size_t>(scenario_.pings.recording_duration *
                                                scenario_.pings.sample_rate)};
  }

  [[nodiscard]] PingReverberation ping(std::uint32_t ping, double time = 0.0, int array = 0) const {
    return model_.ping(
        {.geometry = PingGeometry(scenario_, {.time = time}, static_cast<int>(ping)),
         .pattern = *pattern_,
         .pulse = pulse_,
         .array = array,
         .latest = scenario_.pings.recording_start + scenario_.pings.recording_duration,
         .phones = drawn() ? std::span<const Vec3>(scenario_.arrays[0].phones)
                           : std::span<const Vec3>()});
  }
  [[nodiscard]] Baseband receive(std::span<const Return> returns) const {
    return synthesizer_.baseband(returns, scenario_.arrays[0].phones);
  }
  /// One scatterer after the other, unless the scenario asks for the covariance or for streams.
  [[nodiscard]] Baseband receive(std::uint32_t number, double time = 0.0) const {
    const PingReverberation scattered = ping(number, time);
    Baseband received = synthesizer_.baseband(scattered, scenario_.arrays[0].phones);
    const CovarianceDraw draw{.seed = scenario_.seed, .ping = number};
    if (scattered.covariance() != nullptr)
      synthesizer_.add_gaussian(*scattered.covariance(), draw, received);
    if (scattered.streams() != nullptr)
      synthesizer_.add_streams(*scattered.streams(), scenario_.arrays[0].phones, draw, received);
    return received;
  }

 private:
  [[nodiscard]] bool drawn() const {
    const ScattererSynthesis how = scenario_.reverberation.synthesis;
    return how == ScattererSynthesis::covariance || how == ScattererSynthesis::streams;
  }
  [[nodiscard]] Vec3 source() const { return scenario_.platforms[0].track.at(0.0).position; }

  Scenario scenario_;
  PropagationPaths paths_;
  Pulse pulse_;
  std::unique_ptr<TransmitPattern> pattern_;
  ReverberationModel model_;
  Synthesizer synthesizer_;
};

/// The complex envelope of a phone at a time, nearest sample.
inline std::complex<double> at(const Baseband& received, std::size_t channel, double t) {
  const auto i = static_cast<std::size_t>(std::lround((t - received.start) * received.sample_rate));
  return std::complex<double>(received.channel(channel)[i]);
}

}  // namespace asdic::detail::support
