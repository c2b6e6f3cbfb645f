#include "app/sonar_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"
#include "core/geometry.h"
#include "sonar/noise/noise_spectrum.h"

namespace asdic::detail::app {
namespace {

std::string position(const Vec3& p) {
  return fmt::format("{:g} m east, {:g} m north, {:g} m {}", p.x(), p.y(), std::abs(p.z()),
                     p.z() < 0.0 ? "above the surface" : "deep");
}

std::string motion(const Vec3& v) {
  return v.isZero() ? "at rest" : fmt::format("moving at {:.2f} m/s", v.norm());
}

/// ", closing at 5.00 m/s": how fast two that move come nearer.
std::string closing_text(const Kinematics& from, const Kinematics& to) {
  const Vec3 between = to.position - from.position, moves = to.velocity - from.velocity;
  const double distance = between.norm();
  if (moves.isZero() || distance == 0.0) return "";
  const double opening = moves.dot(between) / distance;
  return fmt::format(", {} at {:.2f} m/s", opening < 0.0 ? "closing" : "opening",
                     std::abs(opening));
}

std::string reverberation_text(const Scenario& s, double spacing, int planes) {
  const ReverberationSettings& r = s.reverberation;
  std::string text =
      r.enabled && r.surface_scatters
          ? fmt::format("surface reverberation  {}, {}{} azimuths, ground grid of {:.3g} m\n",
                        name_of(r.surface), r.resolve_azimuth ? "at least " : "", r.azimuths,
                        spacing)
          : "surface reverberation  none\n";
  if (!r.enabled) return text;
  if (s.area)
    text += fmt::format("                       followed in {} vertical planes about a place\n",
                        planes);
  if (r.bottom) text += fmt::format("bottom reverberation   {}\n", name_of(*r.bottom));
  for (const VolumeLayer& layer : r.volume)
    text += fmt::format("volume reverberation   {:g} dB re 1/m from {:g} to {:g} m\n",
                        layer.strength_db, layer.top, layer.bottom);
  return text;
}

/// "transmitter" or, where there are several, "transmitter NAME on PLATFORM".
template <class Carried>
std::string carried(const Scenario& s, std::string_view what, const Carried& one,
                    std::size_t count) {
  if (count == 1 && s.platforms.size() == 1) return fmt::format("{:<10} ", what);
  return fmt::format("{:<10} {} on {}: ", what, one.name,
                     s.platforms[static_cast<std::size_t>(one.platform)].name);
}

std::string pulse_text(const Scenario& s, int transmitter) {
  constexpr const char* windows[] = {"no window", "Hann window", "Tukey window"};
  const PulseSettings& settings = pulse_of(s, transmitter);
  const Pulse pulse(settings);
  // Of tones at once, and of a train: the source level is that of the peak.
  const double below = pulse.below_a_tone_db();
  const std::string weaker =
      below > 0.05 && !samples_of(settings.waveform)
          ? fmt::format(", {:.1f} dB less energy than a tone of its peak", below)
          : "";
  return fmt::format("pulse      {}, {:g} Hz, {:g} s, {}, band {:g} Hz{}\n",
                     title_of(settings.waveform), pulse.centre_frequency(), pulse.duration(),
                     windows[static_cast<int>(settings.window)], pulse.bandwidth_40db(), weaker);
}

/// ", 150 m deep" of what does not hang where its platform is; "" of what does.
std::string depth_text(const Scenario& s, int platform, double shallowest, double deepest) {
  const double carrier = s.platforms[static_cast<std::size_t>(platform)].track.at(0.0).position.z();
  if (shallowest == carrier && deepest == carrier) return "";
  if (deepest - shallowest < 0.1) return fmt::format(", {:.4g} m deep", deepest);
  return fmt::format(", {:.4g} to {:.4g} m deep", shallowest, deepest);
}

std::string transmitter_text(const PingSimulator& simulator, std::size_t t) {
  const Scenario& s = simulator.scenario();
  const Transmitter& one = s.transmitters[t];
  const std::string who = carried(s, "projector", one, s.transmitters.size());
  const double depth = sender_of(s, static_cast<int>(t)).at(0.0).position.z();
  const std::string where = depth_text(s, one.platform, depth, depth) + "\n";
  double elevation = one.elevation;
  for (int ping = 1; ping <= simulator.pings(); ++ping) {
    if (simulator.transmission(ping).transmitter != static_cast<int>(t)) continue;
    elevation = simulator.transmission(ping).elevation;  // of its first ping
    break;
  }
  const std::string beam =
      std::visit([&](const auto& form) { return form.text(elevation); }, one.beam);
  return who + fmt::format("{:g} dB, {}", one.source_level_db, beam) + where;
}

/// What the phones' electronics do, if they are not ideal.
std::string electronics_text(const Electronics& e) {
  if (e.is_ideal()) return "";
  std::string text;
  if (!e.gain_db.empty() || !e.phase.empty() || e.gain_std_db > 0.0 || e.phase_std > 0.0)
    text += ", gain or phase errors";
  if (e.gain_std_db > 0.0 || e.phase_std > 0.0)
    text += fmt::format(" (drawn: {:g} dB, {:g} deg)", e.gain_std_db, degrees(e.phase_std));
  if (!e.dead.empty()) text += ", " + std::to_string(e.dead.size()) + " dead";
  if (e.band_pass)
    text += fmt::format(", band-pass {:g} to {:g} Hz", e.band_pass->low, e.band_pass->high);
  if (e.converter)
    text += fmt::format(", {} bits to {:g} Pa", e.converter->bits, e.converter->full_scale);
  return "electronics  " + text.substr(2) + "\n";
}

std::string array_text(const Scenario& s, std::size_t index) {
  const ReceiverArray& array = s.arrays[index];
  double aperture = 0.0;
  for (const Vec3& a : array.phones)
    for (const Vec3& b : {array.phones.front(), array.phones.back()})
      aperture = std::max(aperture, (a - b).norm());
  std::string text =
      carried(s, "array", array, s.arrays.size()) + count_of(array.phones.size(), "phone");
  if (array.towed) {
    const auto [first, last] =
        std::minmax_element(array.towed->behind.begin(), array.towed->behind.end());
    text += fmt::format(", towed, {:g} to {:g} m behind along the path", *first, *last);
  } else if (array.shapes.size() > 1) {
    text += fmt::format(", {} shapes in turn", array.shapes.size());
  } else {
    text += fmt::format(", {:g} m across", aperture);
  }
  const ArrayMotion motion(s, static_cast<int>(index));
  const double hung = motion.at(0.0).position.z();
  double shallowest = infinity, deepest = -infinity;
  for (const Vec3& phone : motion.phones(1, 0.0)) {
    shallowest = std::min(shallowest, hung + phone.z());
    deepest = std::max(deepest, hung + phone.z());
  }
  text += depth_text(s, array.platform, shallowest, deepest);
  return text + "\n" + electronics_text(array.electronics);
}

/// "10 dB", or what it is by aspect or of its highlights.
std::string strength_text(const Target& target) {
  constexpr const char* fluctuations[] = {"", ", Swerling 1", ", Swerling 2", ", Swerling 3",
                                          ", Swerling 4"};
  std::string text = fmt::format("{:g} dB", target.strength_db);
  if (target.aspect) {
    const auto [low, high] =
        std::minmax_element(target.aspect->strength_db.begin(), target.aspect->strength_db.end());
    text = fmt::format("{:g} to {:g} dB by aspect", *low, *high);
  } else if (!target.highlights.empty()) {
    double low = infinity, high = -infinity;
    for (int degree = 0; degree < 360; ++degree) {
      const double now = strength_db(target, radians(degree));
      low = std::min(low, now), high = std::max(high, now);
    }
    text = fmt::format("{}, together {:.1f} to {:.1f} dB by aspect",
                       count_of(target.highlights.size(), "highlight"), low, high);
  }
  return text + fluctuations[static_cast<int>(target.fluctuation)];
}

std::string between_phones(NoiseCoherence coherence) {
  switch (coherence) {
    case NoiseCoherence::isotropic:
      return ", isotropic";
    case NoiseCoherence::surface:
      return ", from a sheet under the surface";
    case NoiseCoherence::profile:
      return ", by a profile over elevation";
    case NoiseCoherence::independent:
      break;
  }
  return "";
}

/// Which spectrum, and what it comes to at the pulse; between the phones.
std::string noise_text(const PingSimulator& simulator) {
  const NoiseSettings& noise = simulator.scenario().noise;
  if (!noise.any()) return "noise      none\n";
  const double f = simulator.pulse().centre_frequency();
  std::string text =
      "noise      " + std::visit([](const auto& law) { return law.text(); }, *noise.law);
  if (noise.thermal) text += ", thermal";
  if (!noise.flat_level_db())
    text += fmt::format(": {:.1f} dB re 1 µPa²/Hz at {:g} Hz", noise_level_db(noise, f), f);
  return text + between_phones(noise.coherence) + "\n";
}

}  // namespace

std::string sonar_text(const PingSimulator& simulator) {
  const Scenario& s = simulator.scenario();
  const Kinematics platform = s.platforms[0].track.at(0.0);
  std::string text;
  for (const Platform& one : s.platforms) {
    const Kinematics k = one.track.at(0.0);
    text += fmt::format("platform   {}{}, {}\n", s.platforms.size() > 1 ? one.name + ": " : "",
                        position(k.position), motion(k.velocity));
  }
  for (std::size_t t = 0; t < s.transmitters.size(); ++t) {
    text += transmitter_text(simulator, t);
    if (t == 0 || s.transmitters[t].pulse) text += pulse_text(s, static_cast<int>(t));
  }
  for (std::size_t i = 0; i < s.arrays.size(); ++i) text += array_text(s, i);
  for (const Target& target : s.targets) {
    const Kinematics k = target.track.at(0.0);
    const Separation way = separation(platform.position, k.position);
    text +=
        fmt::format("target     {}: {}, {}, range {:.3f} km, bearing {:.1f} deg true, {}\n",
                    target.name, strength_text(target), position(k.position), way.range / 1000.0,
                    compass_degrees(way.bearing), motion(k.velocity) + closing_text(platform, k));
  }
  for (const Interferer& ship : s.interferers) {
    const Kinematics k = ship.track.at(0.0);
    text += fmt::format("interferer {}: {}, {}, {}{}\n", ship.name, position(k.position),
                        motion(k.velocity), ship.level_db || ship.table ? "broadband, " : "",
                        count_of(ship.tonals.size(), "tonal"));
  }
  text += noise_text(simulator);
  text += reverberation_text(s, simulator.ground_spacing(), simulator.reverberation_planes());
  return text;
}

}  // namespace asdic::detail::app
