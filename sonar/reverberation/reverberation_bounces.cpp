#include "sonar/reverberation/reverberation_bounces.h"

#include <algorithm>
#include <cmath>

#include "core/mixed_bits.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/paths/enough_bounces.h"

namespace asdic::detail {
namespace {

constexpr std::size_t segments = 32;  // of the record
constexpr int rings = 64, first_try = 8;
constexpr int most_ever = 1 << 14;     // bounces that are tried at most in layered water
constexpr int bearings_looked_at = 8;  // and planes, over slopes

/// Adds what comes back from rings around the middle of two ends, by the bounces of either leg.
/// \param most  of the bounces
void look(const ScatteringSheet& sheet, double reach, int most, ReceivedBounces& into) {
  const SheetEnds& ends = sheet.ends();
  const Vec2 middle = 0.5 * (ends.source.position + ends.receiver.position).head<2>();
  // Where a path may stand for hundreds, a place that draws one tells too little of them.
  const int bearings =
      sheet.azimuthally_symmetric() && most < 2 * all_cycles ? 1 : bearings_looked_at;
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
        into.add(pair.delay, surface, bottom, pair.power * area);
      }
    }
}

/// Bounces that are tried. Over slopes each try marches its fans, and in a duct every one of them
/// again all rays that strike nothing. So numbers of the settings are judged by one try.
BounceSearch tries(const PropagationSettings& settings, bool layered) {
  if (layered) return {.first = first_try, .most = most_ever};
  if (!in_numbers(settings)) return {.first = first_try, .most = most_over_slopes};
  const int asked = std::max(*settings.max_surface_bounces, *settings.max_bottom_bounces);
  const int most = std::clamp(2 * asked, fewest_bounces + 1, most_over_slopes);
  return {.first = most, .most = most};
}

/// What a segment may miss, 10 dB under the noise in the pulse's band, in units of what look() adds
/// up: of a source of 1 at 1 m that sounds for a second.
double inaudible(const NoiseSettings& noise, const ReverberationContext& context) {
  const double source_db = context.geometry.transmitter().source_level_db;
  const Pulse& pulse = context.pulse;
  const double noise_db = noise_band_db(noise, pulse.centre_frequency(), pulse.bandwidth_40db());
  return 0.1 * power_from_db(noise_db - source_db) * context.latest / segments / pulse.duration();
}

}  // namespace

Bounces reverberation_bounces(const ScatteringPart& part, const SheetEnds& ends,
                              const BoundaryFans& fans, BoundaryFans::Settings fan, bool layered,
                              const Scenario& scenario, const ReverberationContext& context) {
  const PropagationSettings& settings = scenario.propagation;
  if (in_numbers(settings) && !context.judged) return as_asked(settings);
  SheetEnds centre = ends;
  centre.band = {};
  const double reach = fan.max_range;
  const double max_delay = fan.limits.max_delay, home_slowness = fan.limits.home_slowness;
  fan.spacing = reach / rings;
  fan.sectors = in_numbers(settings) ? bearings_looked_at / 2 : bearings_looked_at;
  BounceSearch search = tries(settings, layered);
  search.segments = segments;
  search.latest = context.latest;
  search.floor = inaudible(scenario.noise, context);
  return search_bounces(settings, search, [&](const PathLimits& limits, ReceivedBounces& received) {
    fan.limits = limits;
    fan.limits.max_delay = max_delay;
    fan.limits.home_slowness = home_slowness;
    const ScatteringSheet sheet(fans.around(ends.source.position, part.level, fan),
                                fans.around(ends.receiver.position, part.level, fan), part.law,
                                centre, context.pattern);
    look(sheet, reach, std::max(limits.max_surface_bounces, limits.max_bottom_bounces), received);
  });
}

}  // namespace asdic::detail
