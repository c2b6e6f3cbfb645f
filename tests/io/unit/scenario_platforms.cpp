#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "io/scenario/scenario_reader.h"

namespace asdic::detail {
namespace {

constexpr const char* two_platforms = R"([environment.bottom]
depth = 5000.0
kind = "rigid"
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[[platform]]
name = "ship"
position = [0.0, 0.0, 10.0]
velocity = [5.0, 0.0, 0.0]
[[platform]]
name = "buoy"
position = [4000.0, 0.0, 200.0]
[[transmitter]]
platform = "ship"
offset = [0.0, 0.0, 90.0]
source_level_db = 220.0
taper = "omnidirectional"
[[transmitter]]
name = "pinger"
platform = "buoy"
source_level_db = 190.0
taper = "omnidirectional"
first_ping_time = 20.0
interval = 30.0
[transmitter.pulse]
kind = "cw"
frequency = 3000.0
duration = 0.1
[pulse]
kind = "cw"
frequency = 4000.0
duration = 1.0
[[array]]
platform = "ship"
kind = "horizontal"
phones = 4
spacing = 0.2
[[array]]
platform = "buoy"
kind = "vertical"
phones = 8
spacing = 0.2
[pings]
count = 2
continuous = true
samples = "baseband"
)";

TEST(ScenarioPlatforms, ReadsSeveralPlatformsTransmittersAndArrays) {
  const Scenario s = parse_scenario(two_platforms, "two.toml");
  ASSERT_EQ(s.platforms.size(), 2U);
  EXPECT_EQ(s.platforms[1].name, "buoy");
  ASSERT_EQ(s.transmitters.size(), 2U);
  EXPECT_EQ(s.transmitters[0].name, "transmitter 1");
  EXPECT_EQ(s.transmitters[1].platform, 1);
  EXPECT_EQ(std::get<Cw>(pulse_of(s, 0).waveform).frequency, 4000.0);
  EXPECT_EQ(std::get<Cw>(pulse_of(s, 1).waveform).frequency, 3000.0);
  EXPECT_EQ(s.transmitters[1].interval, 30.0);
  EXPECT_EQ(transmitter_at(s, 0, 2.0).position, Vec3(10.0, 0.0, 100.0));
  ASSERT_EQ(s.arrays.size(), 2U);
  EXPECT_EQ(s.arrays[1].platform, 1);
  EXPECT_EQ(channels_of(s), 12U);
  EXPECT_EQ(first_channel(s, 1), 4U);
  EXPECT_TRUE(s.pings.continuous);
  EXPECT_EQ(s.pings.samples, Samples::baseband);
}

TEST(ScenarioPlatforms, NamesWhatIsWrongWithSeveralPlatforms) {
  const auto expect_fault = [](std::string from, const std::string& to, const std::string& where,
                               const std::string& expected) {
    std::string text = two_platforms;
    text.replace(text.find(from), from.size(), to);
    try {
      static_cast<void>(parse_scenario(text, "two.toml"));
      ADD_FAILURE() << "no fault: " << to;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(where), std::string::npos) << message;
      EXPECT_NE(message.find(expected), std::string::npos) << message;
    }
  };
  expect_fault("platform = \"buoy\"\nsource", "platform = \"boy\"\nsource",
               "two.toml:21: transmitter[1].platform", "\"buoy\"");
  expect_fault("name = \"buoy\"", "name = \"ship\"", "two.toml:12: platform[1].name",
               "no other platform");
  expect_fault("offset = [0.0, 0.0, 90.0]", "offset = [0.0, 0.0, -90.0]",
               "two.toml:16: transmitter[0].offset", "between the surface");
  expect_fault("samples = \"baseband\"", "samples = \"baseband\"\nsample_rate = 8000.0",
               "two.toml:48: pings.sample_rate", "beside");
  expect_fault("samples = \"baseband\"", "samples = \"baseband\"\nbaseband_rate = 100.0",
               "two.toml:48: pings.baseband_rate", "at least");
  expect_fault("count = 2", "count = 2\nrecording_start = 1.0",
               "two.toml:46: pings.recording_start", "no gaps");
}

}  // namespace
}  // namespace asdic::detail
