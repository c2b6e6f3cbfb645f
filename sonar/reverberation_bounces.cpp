#include <algorithm>
#include <cmath>

#include "sonar/noise_spectrum.h"
#include "sonar/reverberation.h"

namespace asdic {
namespace {

constexpr std::size_t stretches = 32;  // of the record
constexpr int rings = 64, first_try = 8, most_ever = 2048;

/// What comes back from rings around the middle of two ends, by the bounces of either leg.
struct Look {
  EnergyByBounces by_most;     // of all paths
  EnergyByBounces by_numbers;  // 0: within the numbers asked for, 1: beyond
};

void look(const ScatteringSheet& sheet, double reach, const Bounces& asked, Look& into) {
  const SheetEnds& ends = sheet.ends();
  const Vec2 middle = 0.5 * (ends.source.position + ends.receiver.position).head<2>();
  const int bearings = sheet.all_round() ? 1 : 8;
  const double step = reach / rings;
  PathPairs pairs;
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < bearings; ++i) {
      constexpr double golden = 0.6180339887498949;
      const double bearing = 2.0 * pi * ((i + 0.5) / bearings + golden * ring);
      const double range = (ring + 0.5) * step;
      sheet.pairs_at(middle + range * Vec2(std::sin(bearing), std::cos(bearing)), pairs, nullptr,
                     0.0, 0.0, mixed(static_cast<std::uint64_t>(ring), static_cast<unsigned>(i)));
      const double area = 2.0 * pi * range * step / bearings;
      for (const PathPair& pair : pairs.found) {
        const int surface = std::max(pair.out->surface_bounces, pair.back->surface_bounces),
                  bottom = std::max(pair.out->bottom_bounces, pair.back->bottom_bounces);
        const bool beyond = surface > asked.surface || bottom > asked.bottom;
        into.by_most.add(pair.delay, std::max(surface, bottom), pair.power * area);
        into.by_numbers.add(pair.delay, beyond ? 1 : 0, pair.power * area);
      }
    }
}

}  // namespace

/// What a stretch may miss, 10 dB under the noise in the pulse's band, in units of what look() adds
/// up: of a source of 1 at 1 m that sounds for a second.
double ReverberationModel::inaudible(const ReverberationContext& context) const {
  const double source_db =
      scenario_.transmitters[static_cast<std::size_t>(context.transmitter)].source_level_db;
  const Pulse& pulse = context.pulse;
  const double noise_db =
      noise_band_db(scenario_.noise, pulse.centre_frequency(), pulse.bandwidth_40db());
  return 0.1 * power_from_db(noise_db - source_db) * context.latest / stretches / pulse.duration();
}

Bounces ReverberationModel::enough(const Part& part, const SheetEnds& ends,
                                   BoundaryFans::Settings fan,
                                   const ReverberationContext& context) const {
  const PropagationSettings& settings = scenario_.propagation;
  const bool numbers = in_numbers(settings);
  if (!paths_.layered() || (numbers && !context.judged)) return as_asked(settings);
  SheetEnds centre = ends;
  centre.band = {};
  const double reach = fan.max_range, floor = inaudible(context);
  const double max_delay = fan.limits.max_delay, home_slowness = fan.limits.home_slowness;
  fan.spacing = reach / rings;
  for (int most = first_try;; most *= 2) {
    fan.limits = limits_of(unlimited(settings), most);
    fan.limits.max_delay = max_delay;
    fan.limits.home_slowness = home_slowness;
    const ScatteringSheet sheet(fans_.around(ends.source.position, part.level, fan),
                                fans_.around(ends.receiver.position, part.level, fan), part.law,
                                centre, context.pattern);
    const Bounces asked = as_asked(settings, most);
    Look found{.by_most = EnergyByBounces(stretches, context.latest, most, floor),
               .by_numbers = EnergyByBounces(stretches, context.latest, 1, floor)};
    look(sheet, reach, asked, found);
    const bool converged = found.by_most.converged(negligible_db);
    if (!converged && most < most_ever) continue;
    const int bounces = found.by_most.enough(negligible_db);
    Bounces followed = numbers ? asked : as_asked(settings, bounces);
    followed.left_out_db =
        numbers ? found.by_numbers.left_out_db(0) : found.by_most.estimate_db(bounces, converged);
    return followed;
  }
}

}  // namespace asdic
