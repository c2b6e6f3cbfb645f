#include "study/measures/kinds/target_place.h"

#include <cmath>

namespace asdic::detail::study {

void TargetPlace::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  Vec3 place = Vec3::Constant(no_value), from = place;
  if (ping && ping.record->summary[target].present) {
    place = ping.record->targets[target].position;
    from = ping.record->phones[first_channel(ping.scenario, ping.plan.array)];
  }
  const Vec3 off = place - from;
  const double bearing = degrees(std::atan2(off.x(), off.y()));  // from north, clockwise
  to.add("place_east", "m", "of the target from the array, when the ping is sent", off.x());
  to.add("place_north", "m", "of the target from the array, when the ping is sent", off.y());
  to.add("place_range", "m", "horizontal, from the array, when the ping is sent",
         std::hypot(off.x(), off.y()));
  to.add("place_bearing_deg", "degrees", "true, from the array, when the ping is sent",
         bearing < 0.0 ? bearing + 360.0 : bearing);
  to.add("place_depth", "m", "of the target when the ping is sent", place.z());
}

}  // namespace asdic::detail::study
