#pragma once
#include <string>
#include <vector>

#include "raytrace/places/reuse.h"
#include "reverb/power/patch_row.h"
#include "sonar/echoes/echo_path.h"
#include "sonar/noise/received_path.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/paths/leg.h"
#include "sonar/scenario/track.h"
#include "sonar/signal/recording.h"

namespace asdic::detail {

/// Mean-square pressure over the phones against time, with the parts resolved: what comes of this
/// ping alone, whatever of others is received in its record. [n] each [Pa²]
struct LevelSeries {
  double time_step = 0.05;  ///< [s]
  std::vector<float> echo, reverberation, noise;
};

struct TargetSummary {
  std::string name;
  bool present = false;
  int array = 0;           ///< that receives the strongest pair: all that follows is received there
  int paths = 0;           ///< path pairs
  double echo_time = 0.0;  ///< of the strongest pair [s]
  double echo_level_db = 0.0;     ///< of the strongest pair [dB re 1 µPa]
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

/// By what plane waves reverberation is received (sonar/reverberation/phone_groups.h).
struct PlaneWaveFit {
  int groups = 1;      ///< of phones, each about a point of its own, in the array that has most
  double error = 0.0;  ///< of the nearest scatterers' fronts at the worst phone [periods]
};

/// Everything about one ping: what the phones received, and the truth behind it.
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
  std::vector<ReceivedPath> interference;
  LevelSeries levels;
  std::vector<TargetSummary> summary;
  Timings timings;
  Reuse reuse;
  BandFit band;
  PlaneWaveFit plane_waves;
  /// Scatterers with weights that last are drawn anew (ScatteringField::drawn_anew).
  bool sea_drawn_anew = false;
  /// For paths in three dimensions, that were ended for their cost so far, of this ping and before.
  std::size_t ended_searches = 0;
  Bounces bounces;  ///< that were followed, the most of echoes, blast and reverberation

  /// For noise and ships, which are added to it.
  [[nodiscard]] RecordSamples samples() noexcept {
    return {.ping = ping,
            .start_time = start_time,
            .recording = recording,
            .channels = phones.size(),
            .pressure = pressure};
  }
};

}  // namespace asdic::detail
