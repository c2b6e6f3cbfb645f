#include "sonar/reverberation/reverberation_ends.h"

#include <algorithm>
#include <cmath>

#include "reverb/fields/scattering_field.h"
#include "sonar/paths/receiver_legs.h"

namespace asdic::detail {

SheetEnds ends_of(const ReverberationContext& context) {
  const PingGeometry& geometry = context.geometry;
  const Carried receiver_point =
      context.point ? *context.point
                    : geometry.reverberation_point(context.array, context.pulse.centre_frequency());
  const double duration = context.pulse.duration();
  SheetEnds ends = {
      .source = sent_from(geometry.sender().track, geometry.time(), duration),
      .receiver = receiver_point.at(geometry.time()),
      .legs = receiver_legs(receiver_point.track, geometry.time(), context.latest, duration),
      .frequency = context.pulse.centre_frequency(),
      .latest = context.latest,
      .band = context.band};
  ends.source.position += geometry.sender().offset;
  for (ReceiverLeg& leg : ends.legs) leg.line.position += receiver_point.offset;
  // Who moves so little in a record that no phase changes by a twentieth of a radian is at rest.
  constexpr double still = 0.05;  // [rad]
  const double fastest = ends.source.velocity.norm() + ends.receiver.velocity.norm();
  if (ends.legs.empty() && 2.0 * pi * ends.frequency * fastest * ends.latest / slowest_sea < still)
    ends.source.velocity = ends.receiver.velocity = Vec3::Zero();
  return ends;
}

void move_to_source(SheetEnds& ends) {
  const auto tidy = [](double metres) { return 1e-6 * std::round(1e6 * metres); };  // of rounding
  Vec3& receiver = ends.receiver.position;
  receiver.x() = tidy(receiver.x() - ends.source.position.x());
  receiver.y() = tidy(receiver.y() - ends.source.position.y());
  ends.source.position.head<2>().setZero();
}

double way_of_receiver(const SheetEnds& ends) {
  if (ends.legs.empty()) return ends.receiver.velocity.norm() * ends.latest;
  double furthest = (ends.receiver_at(ends.latest) - ends.receiver.position).norm();
  for (const ReceiverLeg& leg : ends.legs)  // straight between its turns
    furthest = std::max(furthest, (ends.receiver_at(leg.until) - ends.receiver.position).norm());
  return furthest;
}

}  // namespace asdic::detail
