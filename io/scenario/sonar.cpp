// Part of sections.h: the tables of a sonar, in the order in which they are read.
#include <algorithm>
#include <limits>

#include "core/fields.h"
#include "io/scenario/sections.h"
#include "reverb/scattering/energy.h"
#include "sonar/scenario/pulse_frequencies.h"

namespace asdic::detail::scenario {
namespace {

/// What settings further on refer to.
void know_water(Fields& settings, const Scenario& scenario) {
  const Boundary &surface = scenario.environment.surface, &bottom = scenario.environment.bottom;
  settings.know("environment.wind_speed", scenario.wind_speed);
  settings.know("environment.shallowest",
                surface.shape ? surface.shape->shallowest() : surface.depth);
  constexpr double around = 100e3;  // of an area [m]
  settings.know("environment.deepest", scenario.area
                                           ? scenario.area->bounds(Vec2::Zero(), around).deepest
                                       : bottom.shape ? bottom.shape->deepest()
                                                      : bottom.depth);
}

/// Noise is that of the wind over the first array, where a map of wind has it.
void know_wind_of_arrays(Fields& settings, Scenario& scenario) {
  if (!scenario.area || !scenario.area->wind()) return;
  const Platform& platform = scenario.platforms[scenario.arrays[0].platform];
  const Vec3& place = platform.track.start.position;
  scenario.wind_speed = scenario.area->wind()->at(place.x(), place.y()).value;
  settings.know("environment.wind_speed", scenario.wind_speed);
}

/// Where ranges and bearings of targets begin.
void know_first_platform(Fields& settings, const Scenario& scenario) {
  const Vec3& place = scenario.platforms[0].track.start.position;
  settings.know("platform[0].east", place.x());
  settings.know("platform[0].north", place.y());
}

/// Phones of towed arrays, where their platforms have laid them when the scenario starts.
void place_towed(Scenario& scenario) {
  for (std::size_t a = 0; a < scenario.arrays.size(); ++a)
    if (scenario.arrays[a].towed)
      scenario.arrays[a].phones = phones_at(scenario, static_cast<int>(a), 1, 0.0);
}

/// What the laws of rough boundaries scatter elsewhere, at the frequencies of the pulses.
void set_scattered_elsewhere(Scenario& scenario) {
  const ReverberationSettings& reverberation = scenario.reverberation;
  if (!reverberation.enabled) return;
  const auto [lowest, highest] = pulse_frequencies(scenario);
  Environment& ocean = scenario.environment;
  const auto set = [&](Boundary& boundary, const auto& law) {
    if (!(boundary.roughness.rms_height > 0.0)) return;
    const double c = sound_speed(ocean, 0.0, boundary.depth_at(0.0)).c;
    boundary.roughness.elsewhere =
        scattered_elsewhere(law, std::max(lowest, 1.0), std::max(highest, 1.0), c);
  };
  if (reverberation.surface_scatters) set(ocean.surface, reverberation.surface);
  if (reverberation.bottom) set(ocean.bottom, *reverberation.bottom);
  if (scenario.area)
    scenario.area = std::make_shared<const Area>(scenario.area->scattering(
        ocean.surface.roughness.elsewhere, ocean.bottom.roughness.elsewhere));
}

}  // namespace

void describe_head(Fields& field, Scenario& scenario) {
  field(seldom("title"), scenario.title, "of the scenario");
  field(live("seed"), scenario.seed, 0, std::numeric_limits<std::int64_t>::max(),
        "of all that is drawn");
}

void describe_bodies(Fields& field, Scenario& scenario) {
  know_water(field, scenario);
  field("platform", scenario.platforms, "what carries transmitters and arrays",
        {.one_or_more = true, .named = "platform"});
  field("transmitter", scenario.transmitters, "what sends the pulses",
        {.one_or_more = true, .named = "transmitter"});
  field("array", scenario.arrays, "of hydrophones", {.one_or_more = true, .named = "array"});
  if (field.reads()) place_towed(scenario);
  know_wind_of_arrays(field, scenario);
  know_first_platform(field, scenario);
  field("target", scenario.targets, "what sends echoes", {.named = "target"});
  field("interferer", scenario.interferers, "ships that make noise", {.named = "interferer"});
  field(live("noise"), scenario.noise, "of the sea at the phones");
}

void describe_sound(Fields& field, Scenario& scenario) {
  field("reverberation", scenario.reverberation, "of surface, bottom and water");
  if (field.reads()) {
    set_sea(scenario.reverberation.surface, scenario.wind_speed,
            scenario.environment.water.at(scenario.environment.surface.depth).c);
    set_scattered_elsewhere(scenario);
  }
  field("propagation", scenario.propagation, "the paths that are searched for");
  field("pings", scenario.pings, "when pings are sent and how they are recorded");
}

}  // namespace asdic::detail::scenario
