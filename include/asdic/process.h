#pragma once

/// \file
/// What a sonar makes of pings: matched filters, beams, detections, places, tracks.
///
/// ```cpp
/// asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// scenario.set("pings.recording_duration", 36.0);
/// asdic::write_pings("received.h5", scenario);
/// const asdic::Processed received = asdic::process("received.h5", {.target_depth = 125.0});
/// for (const asdic::Detection& found : received.detections)
///   for (const asdic::Place& place : found.places)
///     std::cout << found.time << " s: " << place.range << " m away, target " << found.target <<
///     '\n';
/// ```

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/ping.h"
#include "asdic/units.h"
#include "asdic/watch.h"

namespace asdic {

/// How to process what was received: the options of `asdic process`, with its defaults.
struct Receiving {
  bool mvdr = false;              ///< adaptive beams, else conventional ones
  bool hann_shading = false;      ///< of the phones, in conventional beams
  double max_speed = 15.0;        ///< closing or opening, that the Doppler filters reach [m/s]
  bool split_window = true;       ///< the background: split windows, else cell averaging
  bool across_beams = true;       ///< compare a peak with the beams around, too
  double guard_cells = 2.0;       ///< left out on either side
  double reference_cells = 12.0;  ///< averaged on either side
  double false_alarm_probability = 1e-6;  ///< of a cell
  int sub_bands = 1;                      ///< that a pulse is cut into; their powers are averaged
  /// Whether the transmissions' own sound is taken out of the record first; none: where echoes come
  /// while a transmitter of a continuous record sends on.
  std::optional<bool> cancel_direct_blast = {};
  /// Nothing before is detected [s]; the pulse's duration, or 0 while a transmitter sends on
  std::optional<double> from = {};
  std::optional<double> until = {};         ///< nor after [s]
  std::optional<double> target_depth = {};  ///< of what answers [m]
  std::optional<double> range_speed = {};   ///< straight rays of this speed instead [m/s]
};

/// Where a thing may be that answers so.
struct Place {
  Vector position{};        ///< when the sound struck it [m]
  double range = 0.0;       ///< horizontal, from the array when it received it [m]
  double bearing = 0.0;     ///< true; NaN if the array tells none [rad]
  double range_rate = 0.0;  ///< [m/s]
  /// On the Earth; NaN unless the scenario says where its map is (environment.origin) [degrees].
  double latitude_deg = std::numeric_limits<double>::quiet_NaN();
  double longitude_deg = std::numeric_limits<double>::quiet_NaN();
};

/// One thing that is no background.
struct Detection {
  int ping = 1;                 ///< from 1
  int array = 0;                ///< in the scenario, from 0
  double time = 0.0;            ///< of its leading edge, after the ping's start [s]
  double doppler = 1.0;         ///< received over transmitted frequency
  double look_bearing = 0.0;    ///< true; NaN if the array tells none [rad]
  double look_elevation = 0.0;  ///< positive up; NaN if the array tells none [rad]
  double snr_db = 0.0;          ///< peak over the background around it [dB]
  double excess_db = 0.0;       ///< peak over the threshold [dB]
  double level_db = 0.0;        ///< of an echo from there [dB re 1 µPa]
  std::vector<Place> places{};  ///< one; two where left and right look alike; none: no path fits
  /// Whose it is: a target of the scenario, −1 a false alarm, −2 the direct sound, −3 another ping.
  int target = -1;
};

struct TrackPoint {
  int ping = 1;                      ///< from 1
  int detection = -1;                ///< in Processed::detections; −1: none, coasted
  double time = 0.0;                 ///< since the start of the scenario [s]
  std::array<double, 2> position{};  ///< east, north [m]
  std::array<double, 2> velocity{};  ///< east, north [m/s]
  double position_sigma = 0.0;       ///< [m]
  /// On the Earth, as in Place [degrees].
  double latitude_deg = std::numeric_limits<double>::quiet_NaN();
  double longitude_deg = std::numeric_limits<double>::quiet_NaN();
};

/// What is believed to be one thing over several pings.
struct Track {
  int array = 0;
  bool ambiguous = false;  ///< there is one like it on the other side of the line
  int target = -1;         ///< that most of its detections are of; −1: none
  std::vector<TrackPoint> points{};
};

struct Processed {
  std::vector<Detection> detections{};
  std::vector<Track> tracks{};          ///< of two pings or more
  std::vector<std::string> warnings{};  ///< what to know before trusting it
  std::vector<std::string> notes{};     ///< what was done to the records, and what that costs
  bool on_earth = false;                ///< whether places have latitudes and longitudes
};

/// All pings of a file. The file stays as it is. \throws InputError, RunError
[[nodiscard]] ASDIC_API Processed process(const std::filesystem::path& file,
                                          const Receiving& receiving = {}, const Watch& watch = {});
/// One ping. Of a continuous record only one that was read from a file will do.
[[nodiscard]] ASDIC_API Processed process(const Ping& ping, const Receiving& receiving = {},
                                          const Watch& watch = {});
/// Pings of one scenario, in the order in which they were sent.
[[nodiscard]] ASDIC_API Processed process(const std::vector<Ping>& pings,
                                          const Receiving& receiving = {}, const Watch& watch = {});

}  // namespace asdic
