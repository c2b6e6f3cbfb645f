#include "sonar/echoes/outer_phones.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace asdic::detail {
namespace {

constexpr double tolerable = 0.0316;  // difference of pressure: −30 dB

double energy_of(const Arrivals& paths, bool waves_alone) {
  double sum = 0.0;
  for (const Arrival& path : paths)
    if (!waves_alone || path.kind != ArrivalKind::ray) sum += std::norm(path.amplitude);
  return sum;
}

/// Whether plane waves from the reference point may fail to describe the sound at the phones.
bool is_to_be_judged(const PropagationPaths& paths, const Arrivals& arrived) {
  if (paths.layered())
    return energy_of(arrived, true) > tolerable * tolerable * energy_of(arrived, false);
  return std::any_of(arrived.begin(), arrived.end(),
                     [](const Arrival& path) { return path.bottom_bounces > 0; });
}

/// Outermost phones up and down, north and south, east and west; the first of several.
std::set<int> outermost(const std::vector<Vec3>& phones) {
  std::set<int> found;
  for (const int axis : {0, 1, 2}) {
    const auto [least, most] =
        std::minmax_element(phones.begin(), phones.end(),
                            [&](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    for (const auto& one : {least, most}) found.insert(static_cast<int>(one - phones.begin()));
  }
  return found;
}

/// Root of the energy of the difference between the paths at a place and the plane waves of the
/// reference point there, over the energy at the reference point.
double difference(const PropagationPaths& paths, const ArrivedLeg& reference,
                  const ArrivedLeg& elsewhere, double frequency) {
  const double c = paths.speed_at(reference.place);
  const Vec3 x = elsewhere.place - reference.place;
  double off = 0.0;
  for (const Arrival& path : reference.leg.arrivals) {
    const Arrival* same = same_path(elsewhere.leg.arrivals, path, paths.layered());
    const double late =
        same == nullptr
            ? 0.0
            : same->delay - path.delay - arriving_slowness(reference.leg.bearing, path, c).dot(x);
    const std::complex<double> there =
        same == nullptr ? 0.0 : same->amplitude * std::polar(1.0, -2.0 * pi * frequency * late);
    off += std::norm(there - path.amplitude);
  }
  return std::sqrt(off / energy_of(reference.leg.arrivals, false));
}

}  // namespace

bool is_alike(const EchoContext& context, const ArrivedLeg& reference,
              const ArrivedLeg& elsewhere) {
  double highest = context.frequency;
  if (const Pulse* pulse = context.pulse; pulse != nullptr)
    highest = pulse->centre_frequency() + 0.5 * pulse->bandwidth_99();
  return difference(context.paths, reference, elsewhere, highest) <= tolerable;
}

bool is_alike_at_phones(const EchoContext& context, const ArrivedLeg& reference,
                        const std::function<ArrivedLeg(int phone)>& at_phone) {
  const std::vector<Vec3>& phones = context.geometry.phones(context.array);
  if (phones.size() < 2 || !is_to_be_judged(context.paths, reference.leg.arrivals)) return true;
  const std::set<int> outer = outermost(phones);
  return std::all_of(outer.begin(), outer.end(),
                     [&](int phone) { return is_alike(context, reference, at_phone(phone)); });
}

}  // namespace asdic::detail
