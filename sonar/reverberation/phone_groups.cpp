#include "sonar/reverberation/phone_groups.h"

#include <algorithm>
#include <cmath>

#include "sonar/scenario/pulse_frequencies.h"

namespace asdic::detail {
namespace {

std::size_t phones_of(const Listening& here) { return here.motion.array().phones.size(); }

/// Height of a place above or below the nearest sheet that scatters [m].
double height_of(const Scenario& scenario, const Vec3& place) {
  const ReverberationSettings& sea = scenario.reverberation;
  double least = infinity;
  if (!sea.enabled) return least;
  const OceanOnMap ocean = ocean_on_map(scenario);
  const auto sheet = [&](double depth) { least = std::min(least, std::abs(depth - place.z())); };
  if (sea.surface_scatters) sheet(ocean.surface_depth(place));
  if (sea.bottom) sheet(ocean.bottom_depth(place));
  for (const VolumeLayer& layer : sea.volume) sheet(std::clamp(place.z(), layer.top, layer.bottom));
  return least;
}

/// Of the phones about their own middle [periods].
double error_of(const Listening& here, const Front& front, PhoneRange phones) {
  if (phones.count < 2) return 0.0;
  const Carried middle = here.motion.middle_of(here.ping, phones);
  return plane_wave_error(here, front, middle, phones) * front.highest_frequency;
}

void halve(const Listening& here, const Front& front, double allowed, PhoneRange phones,
           PhoneGroups& found) {
  const double error = error_of(here, front, phones);
  if (error <= allowed) {
    found.parts.push_back(phones);
    found.error = std::max(found.error, error);
    return;
  }
  const std::size_t half = phones.count / 2;
  halve(here, front, allowed, {phones.first, half}, found);
  halve(here, front, allowed, {phones.first + half, phones.count - half}, found);
}

}  // namespace

Front nearest_reverberation(const PingGeometry& geometry, int array, double duration,
                            double highest_frequency) {
  const Scenario& scenario = geometry.scenario();
  const Vec3& place = geometry.reference_place(array).position;
  const double apart = (geometry.source().position - place).norm();
  const PingSchedule& pings = scenario.pings;
  const double on_ellipse = 0.5 * (speed_at(scenario, place) * duration - apart);
  return {.length = std::max(height_of(scenario, place), on_ellipse),
          .duration = pings.recording_start + pings.recording_duration,
          .highest_frequency = highest_frequency};
}

bool has_long_arrays(const Scenario& scenario) {
  constexpr double wavelengths = 16.0;
  const double highest = pulse_frequencies(scenario).highest;
  for (const ArrayMotion& motion : array_motions(scenario)) {
    double farthest = 0.0;  // from the middle
    for (const Vec3& phone : motion.phones(1, 0.0)) farthest = std::max(farthest, phone.norm());
    const double c = speed_at(scenario, motion.at(0.0).position);
    if (2.0 * farthest * highest > wavelengths * c) return true;
  }
  return false;
}

PhoneGroups one_group(const Listening& here, const Front& front, const Carried& point) {
  const PhoneRange all{0, phones_of(here)};
  return {.parts = {all},
          .error = all.count < 2
                       ? 0.0
                       : plane_wave_error(here, front, point, all) * front.highest_frequency};
}

PhoneGroups phone_groups(const Listening& here, const Front& front, double most, double allowed) {
  const PhoneRange all{0, phones_of(here)};
  for (;; allowed *= 2.0) {
    PhoneGroups found;
    halve(here, front, allowed, all, found);
    if (found.parts.size() == 1 || static_cast<double>(found.parts.size()) <= most) return found;
  }
}

}  // namespace asdic::detail
