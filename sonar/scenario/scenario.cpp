#include "sonar/scenario/scenario.h"

namespace asdic::detail {
double platform_heading(const Scenario& scenario, int platform, double time) {
  const Track& track = scenario.platforms[static_cast<std::size_t>(platform)].track;
  return track.course_at(time).value_or(0.0);
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

}  // namespace asdic::detail
