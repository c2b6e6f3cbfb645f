#include "sonar/warnings/wave_warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/geometry.h"
#include "core/text.h"
#include "raytrace/warnings/warnings.h"
#include "raytrace/waves/diffraction.h"
#include "raytrace/waves/focus.h"
#include "raytrace/waves/interface_wave.h"
#include "raytrace/waves/ray_errors.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/echoes/sparse_sound.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

/// Properties of a leg across the pulse's band.
struct AcrossThePulse {
  double change_db = 0.0;   ///< largest change of waves from the centre to either edge
  double change = 0.0;      ///< largest change of all paths, over the leg's amplitude
  double error = 0.0;       ///< error of the interpolation, over the largest value
  double corners = 0.0;     ///< share of the leg's energy, of turned_at_corners()
  double caustics = 0.0;    ///< the same, of unsure_amplitudes()
  double direct = 0.0;      ///< pressure beside_surface_rays(), over the leg's amplitude
  double interface = 0.0;   ///< pressure of waves along the boundaries, over the leg's amplitude
  double reflection = 0.0;  ///< error of plane-wave reflection, over the leg's amplitude
};

AcrossThePulse across_the_pulse(const PropagationPaths& paths, const MetLeg& leg,
                                const Pulse& pulse, BandOfLosses band) {
  constexpr double matters = 0.01;  // share of the leg's energy
  AcrossThePulse found;
  if (!changes_with_frequency(paths, leg)) return found;
  const double half = 0.5 * pulse.bandwidth_99();
  double energy = 0.0;
  for (const Arrival& path : leg.paths) energy += std::norm(path.amplitude);
  for (const double f : {leg.frequency - half, leg.frequency + half}) {
    const std::vector<std::complex<double>> there = amplitudes_at(paths, leg, f);
    double changed = 0.0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      const std::complex<double> here = leg.paths[i].amplitude;
      changed += std::norm(there[i] - here);
      if (leg.paths[i].kind != ArrivalKind::ray && std::norm(here) >= matters * energy)
        found.change_db =
            std::max(found.change_db, std::abs(db_from_amplitude(std::abs(there[i] / here))));
    }
    if (energy > 0.0) found.change = std::max(found.change, std::sqrt(changed / energy));
  }
  if (band == BandOfLosses::narrow) return found;
  const bool followed = band == BandOfLosses::wide || found.change > tolerable_change;
  if (!followed) return {};
  return {.error = leg_response(paths, leg, leg.frequency, response_half_band(pulse)).error};
}

/// "" where the amplitudes of the centre will do, or those across the band are known.
std::string line_of(const AcrossThePulse& waves, const std::string& whose) {
  std::string text;
  char how_far[32] = "gone";
  constexpr double tolerable_change_db = 1.0, tolerable_share = 0.12, tolerable_error = 0.03;
  if (std::isfinite(waves.change_db))
    std::snprintf(how_far, sizeof how_far, "up to %.2g dB off", waves.change_db);
  if (waves.change > tolerable_share)
    text = formatted(
        "propagation.band: what reaches %s off its boundaries has the reflection of the pulse's "
        "centre; at the edges of its band %.0f %% of the pressure differ; \"wide\" follows it",
        whose.c_str(), 100.0 * waves.change);
  if (waves.change_db > tolerable_change_db)
    text = formatted(
        "propagation.band: what reaches %s where no ray does, or at a caustic, has the "
        "amplitude of the pulse's centre; at the edges of its band it is %s; \"wide\" follows it",
        whose.c_str(), how_far);
  if (waves.error > tolerable_error)
    text = formatted(
        "propagation.band: what reaches %s changes faster across the pulse than %d frequencies "
        "tell: errors up to %.2g of its greatest amplitude",
        whose.c_str(), int(most_wave_frequencies), waves.error);
  return text;
}

/// \param share  of the energy   \param how  it comes: what follows on "the sound to or from it"
std::string line_of_share(double share, const std::string& whose, const char* how) {
  constexpr double tolerable_share = 0.25;
  if (!(share > tolerable_share)) return "";
  return formatted("propagation: %.0f %% of the sound to or from %s %s", 100.0 * share,
                   whose.c_str(), how);
}
constexpr char beside_corners[] =
    "turns so often beside corners of the sound-speed profile that rays have its phase wrong by a "
    "radian; how paths interfere is open";
constexpr char at_caustics[] =
    "comes by rays at a focus, at a caustic which is no simple fold or at the end of their family: "
    "their level may be decibels off";

/// Whether another ray meets this one, ζ < 1, where both have the amplitude of rays still: at what
/// is no simple fold (raytrace/waves/caustics.h).
bool meets_another(const Arrival& path, const Arrivals& paths, double frequency) {
  const double together = 4.0 / 3.0 / (2.0 * pi * frequency);  // of delays, at ζ = 1
  return std::any_of(paths.begin(), paths.end(), [&](const Arrival& other) {
    return other.kind == ArrivalKind::ray && std::abs(other.caustics - path.caustics) == 1 &&
           other.surface_bounces == path.surface_bounces &&
           other.bottom_bounces == path.bottom_bounces &&
           std::abs(other.delay - path.delay) < together &&
           std::abs(other.launch_elevation - path.launch_elevation) < radians(3.0);
  });
}

/// Share of the energy of rays whose amplitude is not to be trusted: they meet at what is no simple
/// fold, pass a focus, or are the last of their family.
double unsure_amplitudes(const EigenraySolver& solver, double source_depth, double receiver_depth,
                         double frequency, const PathLimits& limits, const Arrivals& paths) {
  constexpr double faintest = 0.01, tolerable_error = 0.12;  // 1 dB
  const std::vector<double> errors =
      focusing_errors(solver, source_depth, receiver_depth, frequency, limits, paths, faintest);
  double all = 0.0, unsure = 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double energy = std::norm(paths[i].amplitude);
    all += energy;
    if (paths[i].kind == ArrivalKind::ray &&
        (errors[i] > tolerable_error || meets_another(paths[i], paths, frequency)))
      unsure += energy;
  }
  return all > 0.0 ? unsure / all : 0.0;
}

/// Share of the energy that comes by rays which turn so often, so near a corner of the profile,
/// that their phase is a radian off.
double turned_at_corners(const Environment& ocean, const Arrivals& paths, double frequency) {
  const std::vector<double> errors = corner_errors(ocean, frequency, paths, false);
  double all = 0.0, off = 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double energy = std::norm(paths[i].amplitude);
    all += energy;
    if (paths[i].kind == ArrivalKind::ray && errors[i] > 1.0) off += energy;
  }
  return all > 0.0 ? off / all : 0.0;
}

/// Error of rays that have the boundaries' reflection of plane waves, over the leg's amplitude.
double reflection_error(const Environment& ocean, double source_depth, double frequency,
                        const Arrivals& paths) {
  const std::vector<double> errors = reflection_errors(ocean, source_depth, frequency, paths);
  double all = 0.0, off = 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double energy = std::norm(paths[i].amplitude), error = std::min(errors[i], 1.0);
    all += energy;
    if (paths[i].kind == ArrivalKind::ray) off += energy * error * error;
  }
  return all > 0.0 ? std::sqrt(off / all) : 0.0;
}

/// Pressure of direct sound in its shadow where rays arrive off the surface, over the amplitude of
/// the leg.
double beside_surface_rays(const Environment& ocean, double source_depth, double receiver_depth,
                           double range, double frequency, const Arrivals& paths) {
  const auto direct =
      pressure_beside_surface_rays(ocean, source_depth, receiver_depth, range, frequency, paths);
  double energy = 0.0;
  for (const Arrival& path : paths) energy += std::norm(path.amplitude);
  return direct && energy > 0.0 ? *direct / std::sqrt(energy) : 0.0;
}

/// Pressure of waves along the boundaries over the amplitude of the leg.
double along_boundaries(const Environment& ocean, double source_depth, double receiver_depth,
                        double range, double frequency, const Arrivals& paths) {
  double energy = 0.0;
  for (const Arrival& path : paths) energy += std::norm(path.amplitude) + path.scattered;
  if (!(energy > 0.0)) return 0.0;
  return interface_wave_pressure(ocean, source_depth, receiver_depth, range, frequency) /
         std::sqrt(energy);
}

/// \param share  pressure over that of the rays   \param what  is left out
std::string line_of_lack(double share, double tolerable_share, const std::string& whose,
                         const char* what) {
  if (!(share > tolerable_share)) return "";
  return formatted("propagation: %s %s is left out, roughly %.1g times the pressure of its rays",
                   whose.c_str(), what, share);
}
constexpr char waves_along_a_boundary[] =
    "is reached by waves along a boundary, which are no rays; their sound";
constexpr char hidden_direct_sound[] =
    "has rays off the boundaries, and no direct ray goes to or from it; the direct sound that "
    "waves carry there";

std::string line_of_reflection(double error, const std::string& whose) {
  constexpr double tolerable_error = 0.12;  // 1 dB
  if (!(error > tolerable_error)) return "";
  return formatted(
      "propagation: the sound to or from %s is reflected as plane waves are, by which about %.0f "
      "%% "
      "of its pressure may be off",
      whose.c_str(), 100.0 * error);
}

/// Sound of rays from a source at a place.
struct Reached {
  bool in_the_water = false;  ///< by a ray without the bottom
  double by_rays = 0.0;       ///< Σ|A|² [1/m² × 1 m²]
};

Reached reached(const PropagationPaths& paths, const PropagationSettings& settings,
                const Vec3& source, double depth, double range, double frequency, double latest) {
  const Vec3 place = source + Vec3(range, 0.0, depth - source.z());
  PathLimits limits =
      limits_of(settings, enough_bounces(paths, settings, source, place, frequency, latest));
  limits.diffraction = false;
  Reached sum;
  for (const Arrival& ray : paths.find(source, place, frequency, limits)) {
    sum.in_the_water = sum.in_the_water || ray.bottom_bounces == 0;
    sum.by_rays += std::norm(ray.amplitude) + ray.scattered;
  }
  return sum;
}

/// Whether waves carry sound to ground that scatters and that rays reach off the bottom alone:
/// where that is affordable, at a few ranges of the record. Both boundaries are held to scatter
/// alike.
std::string dark_ground(const Scenario& scenario, const PropagationPaths& paths, const Vec3& source,
                        double frequency) {
  constexpr std::array shares = {0.04, 0.08, 0.16, 0.32, 0.64, 1.0};
  constexpr double cheaper = 10.0;  // than the dearest arrival
  const Environment& ocean = paths.along_transect().environment();
  const double c = paths.speed_at(source), latest = end_of_record(scenario),
               furthest = 0.5 * c * latest;
  const double wavelength = c / frequency;
  // A wave is nothing at the surface itself; where it turns it is greatest a few lengths below.
  const double gradient = std::abs(ocean.water.at(ocean.surface.depth).dc_dz);
  const double wavenumber = 2.0 * pi / wavelength;
  const double airy_length =
      std::cbrt(c / (2.0 * wavenumber * wavenumber * std::max(gradient, 1e-3)));
  const double top = std::min(ocean.surface.depth + std::max(wavelength, airy_length), source.z()),
               floor = ocean.bottom.depth - 0.01;
  const bool of_surface = scenario.reverberation.surface_scatters,
             of_bottom = scenario.reverberation.bottom.has_value();
  double most = 0.0, nearest = 0.0;
  const char* dark = "";
  for (const double share : shares) {
    const double range = share * furthest;
    const auto at = [&](double depth) {
      return reached(paths, scenario.propagation, source, depth, range, frequency, latest);
    };
    const Reached above = at(top), below = at(floor);
    const double rays = (of_surface ? above.by_rays : 0.0) + (of_bottom ? below.by_rays : 0.0);
    for (const bool surface : {true, false}) {
      const double depth = surface ? top : floor;
      if (!(surface ? of_surface : of_bottom) || (surface ? above : below).in_the_water ||
          !diffraction_is_affordable(ocean, cheaper * range, frequency))
        continue;
      const auto wave = diffracted_arrival(ocean, source.z(), depth, range, frequency);
      if (!wave) continue;
      const double more = 2.0 * db_from_power(1.0 + std::norm(wave->amplitude) / rays);
      if (more > tolerable_db && !(most > tolerable_db))
        nearest = range, dark = surface ? "surface" : "bottom";
      most = std::max(most, more);
    }
  }
  if (!(most > tolerable_db)) return "";
  char how_much[64] = "it is all there is";
  if (std::isfinite(most)) std::snprintf(how_much, sizeof how_much, "up to %.2g dB", most);
  char text[300];
  std::snprintf(text, sizeof text,
                "reverberation: about %.2g km away and beyond no ray reaches the %s without the "
                "bottom; what waves carry there is left out, %s of what scatters there",
                nearest / 1000.0, dark, how_much);
  return text;
}

}  // namespace

std::vector<std::string> wave_warnings(const PingGeometry& geometry, const PropagationPaths& paths,
                                       const Pulse& received, int array) {
  const Scenario& scenario = geometry.scenario();
  const Vec3 &source = geometry.source().position,
             &receiver = geometry.reference_place(array).position;
  const auto judged = [&](const Vec3& from, const Vec3& to) {
    const double centre = received.centre_frequency();
    const PathLimits limits = limits_of(
        scenario.propagation,
        enough_bounces(paths, scenario.propagation, from, to, centre, end_of_record(scenario)));
    const Arrivals arrivals = paths.find(from, to, centre, limits);
    const Separation way = separation(from, to);
    const auto solver = paths.solver(paths.plane(from, way.bearing, way.range));
    const double reflection = reflection_error(solver->environment(), from.z(), centre, arrivals);
    const double interface =
        along_boundaries(solver->environment(), from.z(), to.z(), way.range, centre, arrivals);
    if (!paths.layered()) return AcrossThePulse{.interface = interface, .reflection = reflection};
    AcrossThePulse across = across_the_pulse(
        paths, {.from = from, .to = to, .paths = arrivals, .frequency = centre, .limits = limits},
        received, scenario.propagation.band);
    across.caustics =
        unsure_amplitudes(paths.along_transect(), from.z(), to.z(), centre, limits, arrivals);
    const Environment& ocean = paths.along_transect().environment();
    across.corners = turned_at_corners(ocean, arrivals, centre);
    across.reflection = reflection;
    across.interface = interface;
    across.direct = beside_surface_rays(ocean, from.z(), to.z(), way.range, centre, arrivals);
    return across;
  };
  std::vector<std::string> found;
  if (paths.volume() != nullptr || !scenario.propagation.diffraction) return found;
  for (int t = 0; t < static_cast<int>(scenario.targets.size()); ++t) {
    const Vec3 place = geometry.target_at(t, 0.0).position;
    const std::string name =
        "target \"" + scenario.targets[static_cast<std::size_t>(t)].name + "\"";
    const AcrossThePulse there = judged(source, place), home = judged(place, receiver);
    add_warnings(
        {line_of(there, name), line_of(home, name),
         line_of_share(std::max(there.corners, home.corners), name, beside_corners),
         line_of_share(std::max(there.caustics, home.caustics), name, at_caustics),
         line_of_lack(std::max(there.direct, home.direct), 0.25, name, hidden_direct_sound),
         line_of_lack(std::max(there.interface, home.interface), 0.12, name,
                      waves_along_a_boundary),
         line_of_reflection(std::max(there.reflection, home.reflection), name)},
        found);
  }
  if (scenario.propagation.direct_blast && !geometry.is_own(array))
    add_warnings({line_of(judged(source, receiver), "an array")}, found);
  if (scenario.reverberation.enabled && paths.layered())
    add_warnings({dark_ground(scenario, paths, source, received.centre_frequency())}, found);
  return found;
}

}  // namespace asdic::detail
