#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

// A duct of 5 m over a thermocline at 150 Hz. Near the sonar waves add a little to the rays that
// reach the ground; further away there are only waves. The warning names the ground and the range
// at which that begins, not the range at which waves first add anything.
TEST(DarkGround, IsNamedWhereWavesBeginToMatter) {
  const support::TemporaryDirectory folder;
  PingSimulator simulator(read_scenario(folder.write("duct.toml", R"(
[environment.sound_speed]
kind = "table"
depth = [0.0, 5.0, 25.0, 200.0]
speed = [1520.0, 1519.0, 1500.0, 1490.0]
[environment.bottom]
depth = 60.0
kind = "fluid"
speed = 1750.0
density = 1900.0
attenuation_db_per_wavelength = 0.8
[platform]
position = [0.0, 0.0, 10.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 150.0
duration = 0.1
[array]
kind = "horizontal"
phones = 1
spacing = 0.5
[noise]
spectral_level_db = 50.0
[reverberation.surface]
kind = "nrl"
[reverberation.bottom]
kind = "lambert"
mu_db = -27.0
[propagation]
max_surface_bounces = 3
max_bottom_bounces = 3
[pings]
samples = "baseband"
recording_duration = 8.0
)")));
  const std::vector<std::string> warnings = simulator.judge_paths().warnings;
  EXPECT_THAT(warnings, testing::Contains(testing::ContainsRegex(
                            "about 0?[.]?[1-9][0-9.]* km away and beyond no ray reaches the "
                            "(surface|bottom) without the bottom")));
}

}  // namespace
}  // namespace asdic::detail
