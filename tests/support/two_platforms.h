#pragma once
#include "sonar/ping/ping.h"

namespace asdic::detail::support {

/// A transmitter on one platform, an array on another, open water: the direct blast alone.
inline Scenario two_platforms() {
  Scenario s;
  s.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  s.environment.bottom = {.depth = 5000.0, .material = Rigid{}};
  s.platforms = {{.name = "ship", .track = {}}, {.name = "buoy", .track = {}}};
  s.platforms[0].track.start.position = {0.0, 0.0, 100.0};
  s.platforms[1].track.start.position = {900.0, 1200.0, 300.0};
  s.transmitters[0] = {.source_level_db = 200.0, .beam = LineBeam{.taper = Taper::omnidirectional}};
  s.arrays[0] = line_array(3, 0.5, 0.0, 0.0);
  s.arrays[0].platform = 1;
  s.pulse = {.waveform = Lfm{.start_frequency = 950.0, .end_frequency = 1050.0},
             .duration = 0.2,
             .window = PulseWindow::hann};
  s.reverberation.enabled = false;
  s.propagation.max_surface_bounces = 0;
  s.propagation.max_bottom_bounces = 0;
  s.pings = {.count = 1, .interval = 2.0, .recording_duration = 3.0, .sample_rate = 8000.0};
  return s;
}

}  // namespace asdic::detail::support
