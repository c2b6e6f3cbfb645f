#pragma once
#include "sonar/ping/ping.h"

namespace asdic::detail::support {

/// Danesh (MIT 2013), chapter 5: vehicle at 4500 m, 4 kHz, 16 phones at 0.1875 m in a line to the
/// north, broadside to the east; here with nothing that blurs the figure (no noise, reverberation,
/// absorption or directivity) until a test asks for it.
inline Scenario thesis(SoundSpeedProfile water) {
  Scenario s;
  s.environment.water = std::move(water);
  s.environment.bottom = {.depth = 5400.0, .material = Rigid{}};
  s.platforms[0].track.start.position = {0.0, 0.0, 4500.0};
  s.transmitters[0] = {.source_level_db = 230.0, .beam = LineBeam{.taper = Taper::omnidirectional}};
  s.arrays[0] = line_array(16, 0.1875, 0.0, 0.0);
  s.reverberation.enabled = false;
  s.propagation.max_surface_bounces = 0;
  s.propagation.max_bottom_bounces = 0;
  return s;
}

inline Target target(const Vec3& position, double strength_db,
                     const Vec3& velocity = Vec3::Zero()) {
  Target t;
  t.track.start = {.position = position, .velocity = velocity};
  t.strength_db = strength_db;
  return t;
}

}  // namespace asdic::detail::support
