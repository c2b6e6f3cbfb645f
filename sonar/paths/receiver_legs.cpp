#include "sonar/paths/receiver_legs.h"

#include "sonar/paths/delay_curve.h"

namespace asdic::detail {
namespace {

/// The straight way that a track takes at a time, drawn on to another.
Kinematics way_at(const Track& track, double time, double drawn_to) {
  Kinematics way = track.at(time);
  way.position += (drawn_to - time) * way.velocity;
  return way;
}

}  // namespace

std::vector<ReceiverLeg> receiver_legs(const Track& track, double start, double latest,
                                       double pulse) {
  std::vector<ReceiverLeg> legs;
  double from = 0.0;
  const auto add = [&](double until) {
    const Kinematics line = way_at(track, start + 0.5 * (from + until), start);
    if (!legs.empty() && legs.back().line.velocity == line.velocity)
      legs.back().until = until - 0.5 * pulse;
    else
      legs.push_back({.until = until - 0.5 * pulse, .line = line});
    from = until;
  };
  for (const double change : course_changes_of(track, start))
    if (change > 0.0 && change < latest + pulse) add(change);
  add(latest + 2.0 * pulse);
  if (legs.size() == 1) legs.clear();
  return legs;
}

Kinematics sent_from(const Track& track, double start, double pulse) {
  const Kinematics at_once = track.at(start);
  const Kinematics way = way_at(track, start + 0.5 * pulse, start);
  return way.velocity == at_once.velocity ? at_once : way;
}

}  // namespace asdic::detail
