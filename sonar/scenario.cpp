#include "sonar/scenario.h"

namespace asdic {
namespace {

Kinematics on_platform(const Scenario& scenario, int platform, const Vec3& offset, double time) {
  Kinematics place = scenario.platforms[static_cast<std::size_t>(platform)].track.at(time);
  place.position += offset;
  return place;
}

}  // namespace

Kinematics transmitter_at(const Scenario& scenario, int transmitter, double time) {
  const Transmitter& one = scenario.transmitters[static_cast<std::size_t>(transmitter)];
  return on_platform(scenario, one.platform, one.offset, time);
}

Kinematics array_at(const Scenario& scenario, int array, double time) {
  const ReceiverArray& one = scenario.arrays[static_cast<std::size_t>(array)];
  return on_platform(scenario, one.platform, one.offset, time);
}

const PulseSettings& pulse_of(const Scenario& scenario, int transmitter) {
  const Transmitter& one = scenario.transmitters[static_cast<std::size_t>(transmitter)];
  return one.pulse ? *one.pulse : scenario.pulse;
}

std::size_t channels_of(const Scenario& scenario) {
  return first_channel(scenario, static_cast<int>(scenario.arrays.size()));
}

std::size_t first_channel(const Scenario& scenario, int array) {
  std::size_t channels = 0;
  for (int i = 0; i < array; ++i)
    channels += scenario.arrays[static_cast<std::size_t>(i)].phones.size();
  return channels;
}

}  // namespace asdic
