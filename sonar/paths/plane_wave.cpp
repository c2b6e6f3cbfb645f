#include "sonar/paths/plane_wave.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace asdic::detail {

double speed_at(const Scenario& scenario, const Vec3& place) {
  return ocean_on_map(scenario).speed_at(place);
}

double plane_wave_error(const Listening& here, const Front& front, const Carried& point,
                        PhoneRange phones) {
  const double begin = here.ping_time + front.delay;
  const auto phones_then = [&](double time) {
    return here.motion.phones_from(point, here.ping, time);
  };
  const std::vector<Vec3> shape = phones_then(here.ping_time);
  std::vector<std::vector<Vec3>> later;  // shapes while it passes
  if (here.motion.deforms())
    for (const double share : {0.0, 0.5, 1.0})
      later.push_back(phones_then(begin + share * front.duration));
  const Vec3 place = point.at(begin).position;
  const double c = speed_at(here.scenario, place);
  const bool anywhere = front.slowness.isZero(0.0);
  const Vec3 way = anywhere ? Vec3::Zero() : Vec3(front.slowness.normalized());
  double worst = 0.0;
  for (std::size_t n = phones.first; n < phones.first + phones.count; ++n) {
    const Vec3& x = shape[n];
    const double across = std::max(0.0, x.squaredNorm() - std::pow(way.dot(x), 2));  // d²
    const double faster = std::abs(speed_at(here.scenario, place + x) - c);
    double bent = 0.0;
    for (const std::vector<Vec3>& then : later) {
      const Vec3 moved = then[n] - x;
      bent = std::max(bent, anywhere ? moved.norm() / c : std::abs(front.slowness.dot(moved)));
    }
    worst = std::max(worst, across / (2.0 * std::max(front.length, 1.0) * c) +
                                x.norm() * faster / (2.0 * c * c) + bent);
  }
  return worst;
}

double plane_wave_error(const Listening& here, const Front& front) {
  return plane_wave_error(here, front, here.motion.reference(),
                          {0, here.motion.array().phones.size()});
}

bool is_plane_wave(const Listening& here, const Front& front) {
  constexpr double periods = 0.01;
  return plane_wave_error(here, front) * front.highest_frequency <= periods;
}

}  // namespace asdic::detail
