#include "study/measures/kinds/strongest_path.h"

#include <cmath>

namespace asdic::detail::study {

void StrongestPath::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  const EchoPath* best = nullptr;
  if (ping)
    for (const EchoPath& echo : ping.record->echoes)
      if (echo.array == ping.plan.array && echo.target == static_cast<int>(target) &&
          (best == nullptr || echo.level_db > best->level_db))
        best = &echo;
  const auto value = [&](auto of) { return best == nullptr ? no_value : of(*best); };
  to.add("path_delay", "s", "strongest pair of paths: delay of its leading edge",
         value([](const EchoPath& e) { return e.received.delay; }));
  to.add("path_level_db", level_unit, "strongest pair of paths: peak envelope/√2, not windowed",
         value([](const EchoPath& e) { return e.level_db; }));
  to.add("path_doppler", "1", "strongest pair of paths: Doppler factor",
         value([](const EchoPath& e) { return e.received.doppler; }));
  to.add("path_arrival_elevation_deg", "degrees",
         "strongest pair of paths: direction of travel at the array, positive up",
         value([](const EchoPath& e) {
           const Vec3& s = e.received.slowness;
           return degrees(std::atan2(-s.z(), std::hypot(s.x(), s.y())));
         }));
}

}  // namespace asdic::detail::study
