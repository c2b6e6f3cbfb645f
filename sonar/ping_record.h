#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytrace/arrivals.h"
#include "sonar/band_response.h"
#include "sonar/delay_curve.h"
#include "sonar/enough_bounces.h"
#include "sonar/returns.h"
#include "sonar/reuse.h"
#include "sonar/synthesis.h"
#include "sonar/track.h"

namespace asdic {

/// Eigenrays of one leg of the way.
struct Leg {
  enum class Kind { source_to_target, target_to_array, source_to_array, source_to_receiver };
  Kind kind = Kind::source_to_target;
  int target = -1;  ///< index in the scenario, −1 for source_to_array (there and back, no target)
  int array = -1;   ///< index in the scenario, −1 for legs that end elsewhere
  int channel = -1;      ///< its phone, −1 for the array's reference point
  double bearing = 0.0;  ///< direction of travel, clockwise from north [rad]
  double range = 0.0;    ///< horizontal [m]
  Arrivals arrivals;
};

/// One echo: one path out, one path back, one place of the target.
struct EchoPath {
  int target = 0;
  int array = 0;
  int highlight = -1;     ///< of the target, an index; −1: it is a point
  int outgoing = 0;       ///< index in the arrivals of the source_to_target leg
  int returning = 0;      ///< index in the arrivals of the target_to_array leg
  double level_db = 0.0;  ///< peak envelope/√2 of an unwindowed pulse, what rough boundaries
                          ///< scatter about its paths included, in the mean [dB re 1 µPa]
  double struck = 0.0;    ///< when the leading edge meets the target, since the ping's start [s]
  Return heard;           ///< at the array's reference point (or the phone)
  PathColour colour;      ///< for other frequencies than the pulse's centre
  std::complex<double> glint = 1.0;      ///< what the target's place makes of the pressure
  std::optional<DelayCurve> curve = {};  ///< where a constant Doppler factor is not enough
};

/// The echoes of a target at an array where pairs of paths are too many to be taken one by one: the
/// loudest alone are listed, all are heard (sonar/two_step_echo.h).
struct ManyEchoes {
  int target = 0;          ///< index in the scenario
  int array = 0;           ///< index in the scenario
  std::size_t pairs = 0;   ///< of paths, that are heard before the record ends
  double first = 0.0;      ///< when the first of their leading edges is heard …
  double last = 0.0;       ///< … and the last [s]
  bool at_phones = false;  ///< every phone hears paths of its own
  Bounces followed;        ///< on either leg
  double peak = 0.0;       ///< largest envelope at the reference point, over the pulse's at 1 m
};

/// What scatters back from one ground cell, by one path pair: from the whole ring in a layered
/// ocean, otherwise from the sector at `bearing` and the one mirrored about the transect.
struct PatchRow {
  enum class Ground { surface, bottom, volume };
  Ground ground = Ground::surface;  ///< what scatters
  double bearing = 0.0;             ///< of the sector, clockwise from north [rad]; NaN: whole ring
  double range = 0.0;               ///< of the cell's centre from the source [m]
  double area = 0.0;                ///< of the ring, or of the sectors [m²]
  double delay = 0.0;               ///< two-way [s]
  double grazing_in = 0.0;          ///< [rad]
  double grazing_out = 0.0;         ///< [rad]
  double launch_elevation = 0.0;    ///< of the outgoing path [rad]
  double arrival_elevation =
      0.0;  ///< of the returning path at the array, direction of travel [rad]
  double scattering_strength_db = 0.0;  ///< of that pair of angles [dB]
  double level_db =
      0.0;  ///< expected level of that area by this pair, pulse not windowed [dB re 1 µPa]
};

/// Mean-square pressure over the phones against time, with the parts told apart: what comes of this
/// ping alone, whatever of others is heard in its record. [n] each [Pa²]
struct LevelSeries {
  double time_step = 0.05;  ///< [s]
  std::vector<float> echo, reverberation, noise;
};

/// One path along which an interfering ship is heard, at the record's first sample.
struct HeardPath {
  int interferer = 0;            ///< index in the scenario
  int array = 0;                 ///< index in the scenario
  double delay = 0.0;            ///< since it left the ship [s]
  double doppler = 1.0;          ///< heard over sent frequency
  double range = 0.0;            ///< horizontal, from where the ship was [m]
  double bearing = 0.0;          ///< direction of travel, clockwise from north [rad]
  Vec3 slowness = Vec3::Zero();  ///< at the array [s/m]
  Vec3 moveout = Vec3::Zero();  ///< ∇τ there: the slowness over 1 − s·v of the moving ship [s/m]
  Arrival path;
};

struct TargetSummary {
  std::string name;
  bool present = false;
  int array = 0;               ///< that hears the strongest pair: all that follows is heard there
  int paths = 0;               ///< path pairs
  double echo_time = 0.0;      ///< of the strongest pair [s]
  double echo_level_db = 0.0;  ///< of the strongest pair [dB re 1 µPa]
  double reverberation_db = 0.0;  ///< expected level at that time [dB re 1 µPa]
  double noise_db = 0.0;          ///< in the pulse's band [dB re 1 µPa]
  double echo_peak_db = 0.0;  ///< all paths together, as they add at the array's reference point:
                              ///< the peak of their envelope/√2 [dB re 1 µPa]
  double signal_excess_db = 0.0;  ///< that peak over reverberation plus noise in the band, before
                                  ///< any processing gain [dB]
};

struct Timings {
  double rays = 0.0, eigenrays = 0.0, patches = 0.0, synthesis = 0.0, noise = 0.0,
         write = 0.0;  ///< wall time [s]
};

/// How reverberation is known across a pulse's band, where it has amplitudes of its own there.
struct BandFit {
  int points = 1;      ///< frequencies; 1: the centre's amplitudes are taken for all
  double error = 0.0;  ///< of absorption times √σ between them, over its largest value
};

/// By what plane waves reverberation is heard (sonar/phone_groups.h).
struct PlaneWaveFit {
  int groups = 1;      ///< of phones, each about a point of its own, in the array that has most
  double error = 0.0;  ///< of the nearest scatterers' fronts at the worst phone [periods]
};

/// Everything about one ping: what the phones heard, and the truth behind it.
struct PingRecord {
  int ping = 1;             ///< counted from 1
  int transmitter = 0;      ///< that sent it, an index
  double start_time = 0.0;  ///< of the ping in the scenario [s]
  double elevation = 0.0;   ///< of the transmitter [rad]
  Kinematics platform;      ///< the transmitter's
  std::vector<Kinematics> targets;
  std::vector<Vec3> phones;  ///< [channels] of all arrays, positions at the ping's start [m]
  Recording recording;
  std::vector<float> pressure;  ///< [channels × samples × components of the recording] [Pa]
  std::vector<Leg> legs;
  std::vector<EchoPath> echoes;
  std::vector<EchoPath> scattered;      ///< what rough boundaries scatter about the echoes' paths
  std::vector<ManyEchoes> many_echoes;  ///< of which `echoes` lists the loudest
  std::vector<PatchRow> patches;
  std::vector<HeardPath> interference;
  LevelSeries levels;
  std::vector<TargetSummary> summary;
  Timings timings;
  Reuse reuse;
  BandFit band;
  PlaneWaveFit plane_waves;
  Bounces bounces;  ///< that were followed, the most of echoes, blast and reverberation
};

}  // namespace asdic
