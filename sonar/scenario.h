#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/environment.h"
#include "reverb/scattering/models.h"
#include "sonar/array.h"
#include "sonar/pulse.h"
#include "sonar/track.h"
#include "sonar/transect.h"
#include "sonar/transmitter.h"

namespace asdic {

struct Target {
  std::string name = "target";
  Track track;
  double strength_db = 10.0;                        ///< TS [dB]
  int first_ping = 1;                               ///< the target is there from this ping …
  int last_ping = std::numeric_limits<int>::max();  ///< … to this one
};

/// Surface reverberation as scattering patches on one ground grid.
struct ReverberationSettings {
  bool enabled = true;
  AnySurfaceScattering surface =
      NrlSurface{};   ///< wind and surface sound speed are filled in from the environment
  int azimuths = 36;  ///< sectors of a ring, each with its own bearing and weight
  std::optional<double> ground_spacing;  ///< of the grid [m]; by default from the pulse's bandwidth
};

struct NoiseSettings {
  std::optional<double> spectral_level_db;  ///< NL [dB re 1 µPa²/Hz]; none: no noise
};

/// What is searched for. A path is kept when it is within all the limits.
struct PropagationSettings {
  int max_surface_bounces = 3;
  int max_bottom_bounces = 3;
  double max_launch_angle = 0.5 * pi;  ///< from the horizontal [rad]
  bool exact_per_phone = false;  ///< eigenrays to every phone instead of one plane wave per path
};

struct PingSchedule {
  int count = 1;
  double interval = 60.0;            ///< from ping to ping [s]
  std::vector<double> elevations;    ///< transmitter elevation of each ping [rad], repeated as
                                     ///< needed; empty: the transmitter's own
  double recording_duration = 60.0;  ///< after the start of each ping [s]
  double recording_start = 0.0;      ///< [s]
  double sample_rate = 16000.0;      ///< [Hz]
};

/// All that a simulation needs, as plain data. Times in s, lengths in m, angles in rad.
struct Scenario {
  std::string title;
  std::uint64_t seed = 1;
  Environment environment;
  Transect transect;         ///< where its range axis lies on the map
  double wind_speed = 10.0;  ///< at 10 m [m/s]
  Track platform;            ///< carries transmitter and array
  Transmitter transmitter;
  PulseSettings pulse;
  ReceiverArray array;
  std::vector<Target> targets;
  NoiseSettings noise;
  ReverberationSettings reverberation;
  PropagationSettings propagation;
  PingSchedule pings;

  std::string text;                    ///< the scenario file, verbatim
  std::string path;                    ///< where it was read
  std::vector<std::string> overrides;  ///< "key.path=value" that changed the text's values
  std::vector<std::string> notes;      ///< what the reader did that the user should know
};

}  // namespace asdic
