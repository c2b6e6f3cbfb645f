#include "sonar/warnings/warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "core/text.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/places/propagation_paths.h"
#include "raytrace/volume/area_volume.h"
#include "raytrace/waves/diffraction.h"
#include "reverb/fields/ground_spacing.h"
#include "reverb/scattering/energy.h"
#include "sonar/noise/ambient_noise.h"
#include "sonar/noise/noise_coherence.h"
#include "sonar/noise/noise_in_guide.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/reverberation/phone_groups.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail::checks {

std::string pulse_band(const Scenario& scenario) {
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const PulseSettings& settings = pulse_of(scenario, static_cast<int>(t));
    if (samples_of(settings.waveform)) continue;
    const Pulse pulse(settings);
    if (0.5 * pulse.bandwidth_40db() < pulse.centre_frequency()) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "pulse: its band, %g Hz wide about %g Hz, reaches down to 0 Hz: frequencies are "
                  "in Hz, not kHz",
                  pulse.bandwidth_40db(), pulse.centre_frequency());
    return text;
  }
  return "";
}

std::string comb_lines(const Scenario& scenario) {
  constexpr double greatest_offset = 0.04;  // of a Doppler factor from 1: 30 m/s
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const PulseSettings& settings = pulse_of(scenario, static_cast<int>(t));
    const std::vector<Tone> tones = tones_of(settings.waveform);
    int most = 0;
    double at = 1.0;
    for (const Tone& from : tones)
      for (const Tone& to : tones) {
        const double factor = to.frequency / from.frequency;
        if (&from == &to || std::abs(factor - 1.0) > greatest_offset) continue;
        int meeting = 0;  // to half of a line's width
        for (const Tone& sent : tones)
          for (const Tone& other : tones)
            meeting +=
                std::abs(factor * sent.frequency - other.frequency) * settings.duration < 0.5;
        if (meeting > most) {
          most = meeting;
          at = factor;
        }
      }
    if (most < 2) continue;
    char text[200];
    std::snprintf(text, sizeof text,
                  "pulse: a Doppler factor of %.4f puts %d of its %zu lines on others: another "
                  "gap_ratio, fewer lines or a longer pulse keeps them apart",
                  at, most, tones.size());
    return text;
  }
  return "";
}

std::string noise_law_range(const Scenario& scenario) {
  if (!scenario.noise.law) return "";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const std::array<Asked, 1> asked{{{"frequency", pulse.lowest, pulse.highest}}};
  const std::string text = std::visit(
      [&](const auto& law) { return outside(law.validity(), asked); }, *scenario.noise.law);
  return text.empty() ? "" : "noise.kind: " + text;
}

namespace {

/// What is recorded [Hz].
Band recorded_band(const Scenario& scenario) {
  const double rate = recorded_rate(scenario);
  if (scenario.pings.samples != Samples::baseband) return {0.0, 0.5 * rate};
  const double carrier = recorded_carrier(scenario);
  return {std::max(0.0, carrier - 0.5 * rate), carrier + 0.5 * rate};
}

}  // namespace

std::string noise_table_band(const Scenario& scenario) {
  if (!scenario.noise.law) return "";
  const auto* table = std::get_if<NoiseTable>(&*scenario.noise.law);
  if (table == nullptr) return "";
  const double first = table->frequency.front(), last = table->frequency.back();
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const Band recorded = recorded_band(scenario);
  const double inside = std::min(last, recorded.highest) - std::max(first, recorded.lowest);
  constexpr double most_outside = 0.05;  // of the recorded band: its first Hz are in no table
  const bool received = pulse.lowest >= first && pulse.highest <= last;
  if (received && inside >= (1.0 - most_outside) * (recorded.highest - recorded.lowest)) return "";
  char text[256];
  std::snprintf(text, sizeof text,
                "noise: levels from %g to %g Hz stand for %s from %g to %g Hz; beyond their ends "
                "the first and last level are held",
                first, last, received ? "a recorded band" : "a pulse",
                received ? recorded.lowest : pulse.lowest,
                received ? recorded.highest : pulse.highest);
  return text;
}

std::string surface_scattering_range(const Scenario& scenario) {
  const ReverberationSettings& sea = scenario.reverberation;
  if (!sea.enabled || !sea.surface_scatters) return "";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const std::array<Asked, 2> asked{{{"frequency", pulse.lowest, pulse.highest},
                                    {"wind speed", scenario.wind_speed, scenario.wind_speed}}};
  const std::string text = outside(scattering_validity(sea.surface), asked);
  return text.empty() ? "" : "reverberation.surface.kind: " + text;
}

// Sound that is received as plane waves by an array that is too long or too bent for them.

namespace {

const ReceiverArray& array_of(const Scenario& scenario, int array) {
  return scenario.arrays[static_cast<std::size_t>(array)];
}

/// How far phones get from where they are at a time, seen from their middle [m].
double bent_by(const ArrayMotion& motion, double time, double later) {
  const std::vector<Vec3> before = motion.phones(1, time), after = motion.phones(1, time + later);
  double most = 0.0;
  for (std::size_t n = 0; n < before.size(); ++n)
    most = std::max(most, (after[n] - before[n]).norm());
  return most;
}

/// By how much the coherence of any two phones changes meanwhile: of neighbours, and of some
/// others.
double coherence_change(const ArrayMotion& motion, double time, double later, double wavenumber,
                        const NoiseField& noise) {
  const std::vector<Vec3> before = motion.phones(1, time), after = motion.phones(1, time + later);
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
  const Kinematics receives = ArrayMotion(scenario, 0).at(0.0);
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
    return formatted(
        "reverberation.synthesis: drawn from its covariance, it is plane waves for array "
        "%s: the first are up to %.2g periods off at its ends, 1/16 after %.2g s; with "
        "\"automatic\" they are not",
        array_of(scenario, 0).name.c_str(), error,
        2.0 * far / speed_at(scenario, receives.position));
  }
  return "";
}

std::string noise_of_a_bent_line(const Scenario& scenario) {
  if (!scenario.noise.any() || scenario.noise.coherence == NoiseCoherence::independent) return "";
  const double highest = pulse_frequencies(scenario).highest;
  for (std::size_t a = 0; a < scenario.arrays.size(); ++a) {
    const int array = static_cast<int>(a);
    const ArrayMotion motion(scenario, array);
    if (!motion.deforms()) continue;
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
        bent.emplace_back(bent_by(motion, time, quarter), time);
      }
    std::sort(bent.rbegin(), bent.rend());
    const double c = speed_at(scenario, motion.at(0.0).position);
    const NoiseField field = noise_field(scenario, array);
    double change = 0.0;
    for (std::size_t i = 0; i < std::min(closely, bent.size()) && bent[i].first > 0.0; ++i)
      change = std::max(
          change, coherence_change(motion, bent[i].second, quarter, 2.0 * pi * highest / c, field));
    constexpr double received = 0.1;
    if (change <= received) continue;
    return formatted(
        "noise.coherence: array %s turns, and in each block of %.2g s its noise has the "
        "shape of the block's middle: the coherence of two phones changes by up to %.2g "
        "at %g Hz meanwhile",
        array_of(scenario, array).name.c_str(), block, change, highest);
  }
  return "";
}

std::string beyond_the_map(const Scenario& scenario) {
  return beyond_the_map(scenario, 0.5 * fastest_water(scenario) * end_of_record(scenario));
}

std::string beyond_the_map(const Scenario& scenario, double heard) {
  if (!scenario.area) return "";
  Area::Edge nearest{.distance = heard};
  const std::vector<Transmission> sent = transmissions(scenario);
  for (const Platform& platform : scenario.platforms)
    for (const double time : {sent.front().time, sent.back().time}) {
      const Vec3 place = platform.track.at(time).position;
      const Area::Edge edge = scenario.area->nearest_edge(place.head<2>(), nearest.distance);
      if (edge.distance < nearest.distance) nearest = edge;
    }
  if (nearest.distance >= heard) return "";
  return formatted(
      "environment.area: sound is followed to %.3g km, and %s ends %.3g km away at %.0f "
      "degrees; beyond it its edge goes on",
      heard / 1000.0, nearest.map.c_str(), nearest.distance / 1000.0, degrees(nearest.bearing));
}

std::string wind_elsewhere(const Scenario& scenario) {
  if (!scenario.area || !scenario.area->wind()) return "";
  constexpr double felt = 1.0;  // [m/s]
  const std::vector<Transmission> sent = transmissions(scenario);
  double worst = 0.0;
  std::string where;
  for (const ReceiverArray& array : scenario.arrays)
    for (const double time : {sent.front().time, sent.back().time}) {
      const Vec3 place = scenario.platforms[array.platform].track.at(time).position;
      const double other =
          scenario.area->wind()->at(place.x(), place.y()).value - scenario.wind_speed;
      if (std::abs(other) <= std::abs(worst)) continue;
      worst = other;
      where = scenario.platforms[array.platform].name;
    }
  if (std::abs(worst) < felt) return "";
  return formatted(
      "environment.area.wind: noise is that of %.3g m/s, over the first array when the "
      "scenario starts; over platform %s it comes to be %.3g m/s",
      scenario.wind_speed, where.c_str(), scenario.wind_speed + worst);
}

std::string far_from_the_origin(const Scenario& scenario) {
  if (!scenario.area) return "";
  double furthest = 0.0;
  const auto look = [&](const Track& track) {
    furthest = std::max(furthest, track.at(0.0).position.head<2>().norm());
  };
  for (const Platform& platform : scenario.platforms) look(platform.track);
  for (const Target& target : scenario.targets) look(target.track);
  char text[240] = "";
  constexpr double stretched = 500e3;
  if (scenario.propagation.dimension == 3 && furthest > AreaVolume::measured)
    std::snprintf(text, sizeof text,
                  "propagation.dimension: slopes and fronts are measured to %.0f km of the map's "
                  "[0, 0], and something is %.0f km away: paths that are turned further may be "
                  "missing",
                  AreaVolume::measured / 1000.0, furthest / 1000.0);
  else if (scenario.area->frame().is_geographic() && furthest > stretched)
    std::snprintf(text, sizeof text,
                  "environment.origin: something is %.0f km away from it, where the map stretches "
                  "what lies across by %.2g %%",
                  furthest / 1000.0,
                  100.0 * std::pow(furthest / MapFrame::earth_radius, 2.0) / 6.0);
  return text;
}

std::string noise_from_below(const Scenario& scenario) {
  constexpr double received = 0.1;  // of what comes down
  if (!scenario.noise.any() || scenario.noise.coherence != NoiseCoherence::surface ||
      !ocean_on_map(scenario).varies())
    return "";
  const SentUp most = sent_up(scenario.environment, pulse_frequencies(scenario).lowest);
  if (most.share < received) return "";
  char text[280];
  std::snprintf(
      text, sizeof text,
      "noise.coherence: in an ocean that varies with range \"surface\" is the sheet of sources "
      "above alone; what the bottom sends up again, %.2g dB of it at %.0f degrees, is left out; a "
      "level over elevation (\"profile\") can hold it",
      db_from_power(most.share), degrees(most.angle));
  return text;
}

namespace {

/// Where a surface duct ends, and from which frequency on rays in it are right.
struct SurfaceDuct {
  double depth = 0.0;      ///< of the first maximum of the speed [m]; 0: there is none
  double frequency = 0.0;  ///< ten times that of its first mode, c/(2H·√(2Δc/c)) [Hz]
};

SurfaceDuct surface_duct(const Environment& ocean) {
  constexpr int steps = 500;
  const double top = ocean.surface.depth_at(0.0), bottom = ocean.bottom.depth_at(0.0);
  const double at_surface = sound_speed(ocean, 0.0, top).c;
  double fastest = at_surface;
  for (int i = 1; i <= steps; ++i) {
    const double height = (bottom - top) * std::pow(double(i) / steps, 2);
    const double c = sound_speed(ocean, 0.0, top + height).c;
    if (c < fastest && fastest > at_surface) {
      const double duct = (bottom - top) * std::pow((i - 1.0) / steps, 2);
      const double slope = std::sqrt(2.0 * (fastest - at_surface) / fastest);
      return {duct, 10.0 * fastest / (2.0 * duct * slope)};
    }
    if (c < fastest) break;
    fastest = c;
  }
  return {};
}

std::string over_a_transect(const Environment& ocean) {
  std::string text =
      "propagation: where the ocean varies with range rays are all there is: sound in shadows, "
      "beyond caustics and out of ducts is left out";
  const SurfaceDuct duct = surface_duct(ocean);
  if (duct.depth > 0.0) {
    char more[120];
    std::snprintf(more, sizeof more,
                  "; inside the surface duct of about %.2g m they are right from about %.2g Hz on",
                  duct.depth, duct.frequency);
    text += more;
  }
  return text;
}

}  // namespace

std::string left_out_diffraction(const Scenario& scenario) {
  if (!scenario.propagation.diffraction || scenario.targets.empty()) return "";
  const Environment& ocean = scenario.environment;
  if (ocean_on_map(scenario).varies()) return over_a_transect(ocean);
  if (!is_layered(ocean))
    return "propagation: where losses vary with depth sound in shadows, beyond caustics and out of "
           "ducts is left out";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const double frequency = 0.5 * (pulse.lowest + pulse.highest);
  const Vec3 source = sender_of(scenario, 0).at(0.0).position;
  for (const Target& target : scenario.targets) {
    const Vec3 place = target.track.at(0.0).position;
    const double range = separation(source, place).range;
    if (diffraction_is_affordable(ocean, range, frequency)) continue;
    for (const Arrival& ray : EigenraySolver(ocean).find(source.z(), place.z(), range, frequency,
                                                         limits_of(scenario.propagation)))
      if (ray.bottom_bounces == 0) return "";
    return formatted(
        "propagation: no ray reaches target \"%s\" without the bottom, and %.3g Hz "
        "over %.3g km are too dear for the wave equation: sound out of ducts and into "
        "shadows is left out",
        target.name.c_str(), frequency, range / 1000.0);
  }
  return "";
}

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

namespace {

/// Approximate delay of sound along the straight line between two places [s].
double straight_delay(const Scenario& scenario, const Vec3& from, const Vec3& to) {
  constexpr int parts = 16;
  double slowness = 0.0;
  for (int i = 0; i < parts; ++i)
    slowness += 1.0 / (parts * speed_at(scenario, from + (i + 0.5) / parts * (to - from)));
  return slowness * (to - from).norm();
}

}  // namespace

std::string echo_beside_record(const Scenario& scenario) {
  if (scenario.pings.continuous) return "";
  constexpr std::size_t looked_at = 100;
  const double begin = scenario.pings.recording_start, end = end_of_record(scenario);
  const std::vector<Transmission> sent = transmissions(scenario);
  const std::size_t step = (sent.size() + looked_at - 1) / looked_at;
  for (std::size_t i = 0; i < sent.size(); i += step) {
    const int ping = static_cast<int>(i) + 1;
    const PingGeometry geometry(scenario, sent[i], ping);
    const double duration = pulse_of(scenario, sent[i].transmitter).duration;
    for (std::size_t t = 0; t < scenario.targets.size(); ++t) {
      const Target& target = scenario.targets[t];
      if (ping < target.first_ping || ping > target.last_ping) continue;
      const Vec3 place = geometry.target_at(static_cast<int>(t), 0.0).position;
      const double there = straight_delay(scenario, geometry.source().position, place);
      double first = infinity;
      bool received = scenario.arrays.empty();
      for (std::size_t a = 0; a < scenario.arrays.size() && !received; ++a) {
        const double delay =
            there + straight_delay(scenario, place, geometry.reference_place(int(a)).position);
        first = std::min(first, delay);
        received = delay >= begin && delay + duration <= end;
      }
      if (received) continue;
      char text[256];
      std::snprintf(text, sizeof text,
                    "pings.recording_duration: the echo of target %s is received from about %.3g s "
                    "after ping %d on, for %.3g s; its record holds %g to %g s",
                    target.name.c_str(), first, ping, duration, begin, end);
      return text;
    }
  }
  return "";
}

std::string overlapping_records(const Scenario& scenario) {
  if (scenario.pings.continuous) return "";
  const std::vector<Transmission> sent = transmissions(scenario);
  double nearest = infinity;
  for (std::size_t i = 1; i < sent.size(); ++i)
    nearest = std::min(nearest, sent[i].time - sent[i - 1].time);
  if (!(nearest < (1.0 - 1e-9) * end_of_record(scenario))) return "";
  char text[256];
  std::snprintf(
      text, sizeof text,
      "pings.recording_duration: a ping is recorded until %g s after it was sent, and the "
      "next one is sent %g s after it: no record has what is received of other pings; "
      "pings.continuous = true has all",
      end_of_record(scenario), nearest);
  return text;
}

/// Distance of a place from the nearest boundary that scatters [m]; infinite where none does. The
/// bottom of an area is left out.
static double height_over_scatterers(const Scenario& scenario, const Vec3& place) {
  const ReverberationSettings& sea = scenario.reverberation;
  const Environment& ocean = scenario.environment;
  const double along = scenario.transect.range_of(place.x(), place.y());
  double least = infinity;
  if (sea.surface_scatters) least = std::min(least, place.z() - ocean.surface.depth_at(along));
  if (!scenario.area && (sea.bottom || !sea.seabed.empty()))
    least = std::min(least, ocean.bottom.depth_at(along) - place.z());
  return least;
}

std::string coarse_rings(const Scenario& scenario) {
  const ReverberationSettings& sea = scenario.reverberation;
  const bool scatters =
      sea.surface_scatters || sea.bottom || !sea.seabed.empty() || !sea.volume.empty();
  if (!sea.enabled || !scatters) return "";
  constexpr double too_wide = 8.0;  // re the height: about one scatterer of 36 is that close
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const Platform& platform =
        scenario.platforms[static_cast<std::size_t>(scenario.transmitters[t].platform)];
    const Vec3 place = platform.track.at(0.0).position;
    const double c = speed_at(scenario, place), height = height_over_scatterers(scenario, place);
    const Pulse pulse(pulse_of(scenario, static_cast<int>(t)));
    const double duration = pulse.duration();
    const double spacing = ground_spacing(sea, scenario.environment, pulse.bandwidth_99(), c);
    if (sea.ground_spacing && 2.0 * spacing > c * duration)
      return formatted(
          "reverberation.ground_spacing: between rings %g m apart reverberation is received "
          "%.3g s apart, and the pulse of transmitter %s lasts %.3g s: samples come in "
          "bursts, and those of the first rings may differ from /levels by 10 dB and more; "
          "at most %.3g m fills the gaps",
          spacing, 2.0 * spacing / c, platform.name.c_str(), duration, 0.5 * c * duration);
    if (spacing > too_wide * height)
      return formatted(
          "reverberation.ground_spacing: rings are %.3g m wide, and transmitter %s is %.3g m from "
          "what scatters: few scatterers lie below it, so most pings are fainter than /levels, by "
          "10 dB and more, until %.3g s after they were sent; at most %.3g m is wide enough",
          spacing, platform.name.c_str(), height, 2.0 * spacing / c + duration,
          std::max(2.0 * height, 0.01));
  }
  return "";
}

std::string steered_line(const Scenario& scenario) {
  constexpr double much = 1.25;
  for (const Transmission& sent : transmissions(scenario)) {
    const Transmitter& transmitter =
        scenario.transmitters[static_cast<std::size_t>(sent.transmitter)];
    const auto* line = std::get_if<LineBeam>(&transmitter.beam);
    if (line == nullptr || line->taper == Taper::omnidirectional) continue;
    const double width = line->steered_width(sent.elevation);
    if (width < much * line->beamwidth) continue;
    char text[256];
    std::snprintf(text, sizeof text,
                  "transmitter.beamwidth_deg: steered to %g deg, the line's beam is %.3g deg wide; "
                  "%g deg is its width when it is not steered",
                  degrees(sent.elevation), degrees(width), degrees(line->beamwidth));
    return text;
  }
  return "";
}

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

std::string planes_beside_volume(const Scenario& scenario) {
  const Environment& ocean = scenario.environment;
  if (scenario.propagation.dimension != 3 || (!scenario.area && is_layered(ocean))) return "";
  std::string text =
      "propagation.dimension: echoes, direct sound and ships' noise are turned sideways by floor "
      "and water; ";
  if (scenario.reverberation.enabled) text += "reverberation, ";
  text +=
      "the numbers of bounces that \"auto\" finds and the places that a receiver makes of bearings "
      "keep to vertical planes; waves where no ray goes are left out";
  const std::optional<BoundaryShape>& floor = ocean.bottom.shape;
  if (floor && floor->ranges().size() > 2 &&
      floor->interpolation() == ShapeInterpolation::piecewise_linear)
    text += "; where facets of the floor meet a faint path may be missing";
  return text;
}

}  // namespace asdic::detail::checks

namespace asdic::detail {

std::vector<std::string> warnings(const Scenario& scenario) {
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  std::vector<std::string> all = warnings(scenario.environment, pulse.lowest, pulse.highest);
  add_warnings(
      {checks::pulse_band(scenario), checks::comb_lines(scenario),
       checks::noise_law_range(scenario), checks::noise_table_band(scenario),
       checks::surface_scattering_range(scenario), checks::reverberation_plane_waves(scenario),
       checks::noise_of_a_bent_line(scenario), checks::noise_from_below(scenario),
       checks::left_out_diffraction(scenario), checks::beyond_the_map(scenario),
       checks::wind_elsewhere(scenario), checks::far_from_the_origin(scenario),
       checks::scattering_energy(scenario), checks::planes_beside_volume(scenario),
       checks::echo_beside_record(scenario), checks::overlapping_records(scenario),
       checks::steered_line(scenario), checks::coarse_rings(scenario)},
      all);
  return all;
}

}  // namespace asdic::detail
