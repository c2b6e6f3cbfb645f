// What bounds on paths and one amplitude for a band leave out of a scenario's sound
// (PingSimulator::judge_paths).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "raytrace/warnings/warnings.h"
#include "sonar/ping.h"
#include "sonar/sampling.h"
#include "sonar/wave_warnings.h"

namespace asdic {
namespace {

/// "" where next to nothing is missing.
std::string line_of(const PropagationSettings& settings, const Bounces& followed,
                    const char* sound) {
  if (!(followed.left_out_db > tolerable_db)) return "";
  const char* const key = settings.max_bottom_bounces || !settings.max_surface_bounces
                              ? "propagation.max_bottom_bounces"
                              : "propagation.max_surface_bounces";
  char missing[64] = "all of it at some time";
  if (std::isfinite(followed.left_out_db))
    std::snprintf(missing, sizeof missing, "up to %.2g dB", followed.left_out_db);
  char text[320];
  std::snprintf(text, sizeof text,
                "%s: %s lacks the paths of more than %d bounces off the surface or %d off the "
                "bottom, %s%s",
                key, sound, followed.surface, followed.bottom, missing,
                in_numbers(settings) ? "; \"auto\" follows as many as there is sound in" : "");
  return text;
}

/// The ocean as it is at a range of its transect, the same everywhere.
Environment flat_at(const Environment& ocean, double range) {
  Environment flat = ocean;
  flat.section.reset();
  for (Boundary* boundary : {&flat.surface, &flat.bottom}) {
    const double depth = boundary->depth_at(range);
    boundary->material = boundary->material_at(range);
    boundary->shape.reset();
    boundary->depth = depth;
  }
  if (!ocean.section) return flat;
  constexpr int samples = 65;
  std::vector<double> depths, speeds;
  for (int i = 0; i < samples; ++i) {
    depths.push_back(std::lerp(flat.surface.depth, flat.bottom.depth, i / (samples - 1.0)));
    speeds.push_back(sound_speed(ocean, range, depths.back()).c);
  }
  flat.water = SoundSpeedProfile::table(depths, speeds, Interpolation::c_linear);
  return flat;
}

/// A scenario with its ocean flat, as it is where its first transmitter is, and the bounces that
/// slopes are given; none where that cannot be traced in layers or a platform is not in its water.
std::optional<Scenario> flattened(const Scenario& scenario) {
  Scenario flat = scenario;
  const Vec3 place = transmitter_at(scenario, 0, 0.0).position;
  const double range = scenario.transect.range_of(place.x(), place.y());
  flat.environment = flat_at(scenario.environment, range);
  flat.targets.clear();
  const auto in_water = [&](const Vec3& end) {
    return end.z() > flat.environment.surface.depth && end.z() < flat.environment.bottom.depth;
  };
  bool all = is_layered(flat.environment);
  for (int t = 0; t < static_cast<int>(flat.transmitters.size()); ++t)
    all = all && in_water(transmitter_at(flat, t, 0.0).position);
  for (int a = 0; a < static_cast<int>(flat.arrays.size()); ++a)
    all = all && in_water(array_at(flat, a, 0.0).position);
  if (!all) return std::nullopt;
  const Bounces followed = as_asked(scenario.propagation);
  flat.propagation.max_surface_bounces = followed.surface;
  flat.propagation.max_bottom_bounces = followed.bottom;
  return flat;
}

}  // namespace

Bounces PingSimulator::judged_echoes(const Transmission& sent, int array) const {
  const double frequency = pulse(sent.transmitter).centre_frequency();
  const Vec3 source = transmitter_at(scenario_, sent.transmitter, sent.time).position,
             receiver = array_at(scenario_, array, sent.time).position;
  const auto judged = [&](const Vec3& from, const Vec3& to) {
    return enough_bounces(*paths_, scenario_.propagation, from, to, frequency,
                          end_of_record(scenario_), true);
  };
  Bounces all;
  for (const Target& target : scenario_.targets) {
    const Vec3 place = target.track.at(sent.time).position;
    Bounces legs = judged(source, place);
    const Bounces back = judged(place, receiver);
    const double both = legs.left_out_db + back.left_out_db;
    legs.include(back);
    legs.left_out_db = both;
    all.include(legs);
  }
  return all;
}

Bounces PingSimulator::judged_reverberation(const Transmission& sent, int array) const {
  const Emission emission = emit(sent);
  PingRecord record = blank_record(1, sent);
  MemoryBudget budget = budget_;
  ReverberationContext context = reverberation_context(emission, array, record, {}, {}, &budget);
  context.judged = true;
  if (paths_->layered()) return reverberation_->bounces(context);
  // Over slopes: what the same bounces would leave out of the flat ocean of the transmitter's
  // place.
  const std::optional<Scenario> flat = flattened(scenario_);
  if (!flat) return as_asked(scenario_.propagation);
  const PropagationPaths flat_paths(flat->environment, flat->transect);
  return ReverberationModel(*flat, flat_paths, emission.pulse).bounces(context);
}

std::vector<std::string> PingSimulator::judge_paths() {
  Bounces echoes, reverberated;
  std::vector<std::string> found;
  for (int t = 0; t < static_cast<int>(scenario_.transmitters.size()); ++t) {
    const auto first = std::find_if(transmissions_.begin(), transmissions_.end(),
                                    [&](const Transmission& s) { return s.transmitter == t; });
    if (first == transmissions_.end()) continue;
    for (int a = 0; a < static_cast<int>(scenario_.arrays.size()); ++a) {
      echoes.include(judged_echoes(*first, a));
      for (std::string& text : wave_warnings(scenario_, *paths_, *first, pulse(t), a))
        add_warnings({std::move(text)}, found);
      if (scenario_.reverberation.enabled) reverberated.include(judged_reverberation(*first, a));
    }
  }
  add_warnings({line_of(scenario_.propagation, echoes, "an echo"),
                line_of(scenario_.propagation, reverberated, "reverberation")},
               found);
  scenario_.notes.insert(scenario_.notes.end(), found.begin(), found.end());
  return found;
}

}  // namespace asdic
