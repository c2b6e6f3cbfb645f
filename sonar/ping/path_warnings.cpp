// What bounds on paths and one amplitude for a band leave out of a scenario's sound
// (PingSimulator::judge_paths).
#include <algorithm>

#include "raytrace/warnings/warnings.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/ping/ping.h"
#include "sonar/scenario/sampling.h"
#include "sonar/warnings/wave_warnings.h"

namespace asdic::detail {

Bounces PingSimulator::judged_echoes(const PingGeometry& geometry, int array) const {
  const double frequency = pulse(geometry.sent().transmitter).centre_frequency();
  const Vec3 &source = geometry.source().position,
             &receiver = geometry.reference_place(array).position;
  const auto judged = [&](const Vec3& from, const Vec3& to) {
    return enough_bounces(*paths_, scenario_.propagation, from, to, frequency,
                          end_of_record(scenario_), true);
  };
  Bounces all;
  for (int t = 0; t < static_cast<int>(scenario_.targets.size()); ++t) {
    const Vec3 place = geometry.target_at(t, 0.0).position;
    Bounces legs = judged(source, place);
    const Bounces back = judged(place, receiver);
    const double both = legs.left_out_db + back.left_out_db;
    legs.include(back);
    legs.left_out_db = both;
    all.include(legs);
  }
  return all;
}

Bounces PingSimulator::judged_reverberation(const Emission& emission, int array) const {
  PingRecord record = blank_record(emission.geometry);
  MemoryBudget budget = budget_;
  ReverberationContext context = reverberation_context(emission, array, record, {}, {}, &budget);
  context.judged = true;
  return reverberation_->bounces(context);
}

PingSimulator::JudgedPaths PingSimulator::judge_paths() {
  Bounces echoes, reverberated;
  JudgedPaths judged;
  for (int t = 0; t < static_cast<int>(scenario_.transmitters.size()); ++t) {
    const auto first = std::find_if(transmissions_.begin(), transmissions_.end(),
                                    [&](const Transmission& s) { return s.transmitter == t; });
    if (first == transmissions_.end()) continue;
    const Emission emission = emit(*first, 1);
    for (int a = 0; a < static_cast<int>(scenario_.arrays.size()); ++a) {
      echoes.include(judged_echoes(emission.geometry, a));
      for (std::string& text : wave_warnings(emission.geometry, *paths_, pulse(t), a))
        add_warnings({std::move(text)}, judged.warnings);
      if (scenario_.reverberation.enabled) reverberated.include(judged_reverberation(emission, a));
    }
  }
  judged.followed.include(reverberated);
  add_warnings({lacking(scenario_.propagation, echoes, "an echo"),
                lacking(scenario_.propagation, reverberated, "reverberation")},
               judged.warnings);
  judged.followed.include(echoes);
  add_warnings(judged.warnings, scenario_.notes);
  return judged;
}

}  // namespace asdic::detail
