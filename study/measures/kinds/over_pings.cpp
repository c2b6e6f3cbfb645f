#include "study/measures/kinds/over_pings.h"

namespace asdic::detail::study {
namespace {

/// "ping_3_range"
std::string of_ping_number(int ping, std::string_view what) {
  return "ping_" + std::to_string(ping) + '_' + std::string(what);
}

}  // namespace

void OverPings::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  const PingRunPlan& plan = *ping.plan.run;
  std::vector<double> detected;
  for (const RunPing& one : ping.run.pings) detected.push_back(one.detected[target]);
  RunAnswer answer;
  if (ping) answer = run_answer(detected, plan);
  const auto yes = [&](int at) { return answer.known ? (at < 0 ? 0.0 : 1.0) : no_value; };
  const auto of = [&](int at, auto value) {
    return at < 0 ? no_value : value(ping.run.pings[static_cast<std::size_t>(at)]);
  };
  const auto number = [](const RunPing& one) { return static_cast<double>(one.ping); };
  const auto time = [](const RunPing& one) { return one.time; };
  to.add("detected_ever", "1", "detected in a ping of the run; NaN: a ping is not known",
         yes(answer.first));
  if (plan.initiates())
    to.add("initiated", "1",
           std::to_string(plan.hits) + " detections within " + std::to_string(plan.within) +
               " pings in a row; NaN: a ping is not known",
           yes(answer.initiated));
  to.add("detections", "1", "pings of the run in which it is detected",
         answer.known ? static_cast<double>(answer.detections) : no_value);
  to.add("first_detection_ping", "1", "number of the first ping that detects it; NaN: none",
         of(answer.first, number));
  to.add("first_detection_time", "s",
         "when that ping is sent, after the run's first; NaN: none detects it",
         of(answer.first, time));
  to.add("first_detection_range", "m",
         "horizontal, from the transmitter, when that ping is sent; NaN: none detects it",
         of(answer.first, [&](const RunPing& one) { return one.range[target]; }));
  if (plan.initiates()) {
    to.add("initiation_ping", "1", "number of the ping with which the track begins; NaN: none",
           of(answer.initiated, number));
    to.add("initiation_time", "s", "when that ping is sent, after the run's first; NaN: none",
           of(answer.initiated, time));
  }
  if (plan.tracker) {
    const TargetTrack track =
        ping ? ping.run.tracks.targets[target] : TargetTrack{.error = no_value};
    to.add("tracked", "1", "the tracker believes a track of which most detections are the target's",
           track.believed < 0 ? 0.0 : 1.0);
    to.add("track_ping", "1", "number of the ping with which it is believed; NaN: none",
           of(track.believed, number));
    to.add("track_time", "s", "when that ping is sent, after the run's first; NaN: none",
           of(track.believed, time));
    to.add("track_error", "m", "horizontal, of the track's last place; NaN: none", track.error);
  }
  for (int k = 0; k < plan.count; ++k) {
    const auto value = [&](auto what) {
      return ping ? what(ping.run.pings[static_cast<std::size_t>(k)]) : no_value;
    };
    to.add(of_ping_number(plan.first + k, "detected"), "1", "detected in this ping; NaN: not known",
           value([&](const RunPing& one) { return one.detected[target]; }), Column::Role::ping);
    to.add(of_ping_number(plan.first + k, "range"), "m",
           "horizontal, from the transmitter, when this ping is sent",
           value([&](const RunPing& one) { return one.range[target]; }), Column::Role::ping);
  }
}

void OverPings::of_ping(const MeasuredPing& ping, Collector& to) {
  const PingRunPlan& plan = *ping.plan.run;
  if (plan.tracker)
    to.add("false_tracks", "1", "that the tracker believes, of detections that are nobody's",
           ping.run.tracks.false_tracks);
  for (int k = 0; k < plan.count; ++k)
    to.add(of_ping_number(plan.first + k, "time"), "s", "when it is sent, after the run's first",
           ping ? ping.run.pings[static_cast<std::size_t>(k)].time : no_value, Column::Role::ping);
}

}  // namespace asdic::detail::study
