#pragma once

namespace asdic::detail::support {

/// A scenario without reverberation, fluctuation or curved rays, as text: one straight path there
/// and back at 1500 m/s, white noise, two phones. Studies put their own tables before it.
inline constexpr const char* plain_sea = R"(
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 1000.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 100.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
window = "hann"
[array]
kind = "horizontal"
phones = 2
spacing = 0.75
[[target]]
position = [3000.0, 0.0, 100.0]
strength_db = 10.0
[noise]
spectral_level_db = 40.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
samples = "baseband"
recording_duration = 8.0
)";

}  // namespace asdic::detail::support
