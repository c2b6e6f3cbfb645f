#include <gtest/gtest.h>

#include <cmath>

#include "io/scenario/scenario_reader.h"
#include "reverb/power/reverberation_streams.h"
#include "sonar/ping/ping.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

// In shallow water with three bounces, pieces of ground at the ends of a cell bring no power at
// all. They have no direction, so a sum over all parts (a study's background) would not be a
// number.
TEST(StreamParts, AreAllNumbers) {
  const support::TemporaryDirectory folder;
  PingSimulator simulator(read_scenario(folder.write("sea.toml", R"(
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 100.0
kind = "grain-size"
grain_size = 3.0
[environment.absorption]
kind = "thorp"
[platform]
position = [0.0, 0.0, 10.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "lfm"
start_frequency = 3400.0
end_frequency = 3600.0
duration = 0.25
window = "hann"
[array]
kind = "horizontal"
phones = 8
spacing = 0.2
heading_deg = 0.0
[noise]
spectral_level_db = 55.0
[reverberation.surface]
kind = "nrl"
[reverberation.bottom]
kind = "lambert"
mu_db = -27.0
frozen = false
coherence_time = 0.0
[propagation]
max_surface_bounces = 3
max_bottom_bounces = 3
[pings]
samples = "baseband"
recording_duration = 2.5
)")));
  simulator.receives_one_ping();
  const auto streams = simulator.mean_sea(1, 0).streams;
  ASSERT_GT(streams->parts.size(), 1000U);
  std::size_t none = 0;
  for (const ReverberationStreams::Part& part : streams->parts)
    none += part.slowness[0].allFinite() && part.slowness[1].allFinite() &&
                    std::isfinite(part.doppler + part.curvature[0] + part.curvature[1] +
                                  std::norm(part.weight[0][0]) + std::norm(part.weight[0][1]) +
                                  std::norm(part.weight[1][1]))
                ? 0
                : 1;
  EXPECT_EQ(none, 0U);
  for (const ReverberationStreams::Stream& stream : streams->streams) {
    ASSERT_GT(stream.parts, 0U);
    EXPECT_NEAR(streams->parts[stream.first_part + stream.parts - 1].chance, 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace asdic::detail
