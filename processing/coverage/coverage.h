#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "processing/signal_excess.h"
#include "raytrace/parallel/progress.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {

/// What a picture of the area around a sonar is asked to show.
struct CoverageSettings {
  int ping = 1;         ///< of the run, from 1: whose transmitter, where everything is
  int array = 0;        ///< that listens: the middle of the picture
  int bearings = 360;   ///< cell j from j to j + 1 of so many parts of the circle, from north
  int ranges = 500;     ///< cell i from i to i + 1 of so many parts of the reach
  double reach = 20e3;  ///< [m]
  std::vector<double> depths = {100.0};  ///< of the target [m]
  double strength_db = 10.0;             ///< of the target, at every aspect
  Fluctuation fluctuation = Fluctuation::none;
  double false_alarm_probability = 1e-4;  ///< of a cell
  double reference_cells = 24.0;          ///< averaged for the background; ∞: it is known
};

/// How sure a cell is.
enum class CoverageCertainty : std::int8_t {
  sure = 0,
  no_path = 1,   ///< no ray comes there, or back: a shadow
  edge = 2,      ///< paths begin or end between this cell and a neighbour: a caustic or a shadow's
                 ///< edge, where rays tell the level to `uncertainty_db` alone
  no_water = 3,  ///< the target's depth lies below the sea floor, or above the surface
};
inline constexpr std::string_view coverage_certainty_words[] = {"sure", "no_path", "edge",
                                                                "no_water"};

/// One target depth: [bearings × ranges], range fastest. NaN where nothing is known.
struct CoverageLayer {
  double depth = 0.0;                   ///< [m]
  std::vector<float> echo_db;           ///< mean over the cell [dB re 1 µPa]; −∞: none
  std::vector<float> two_way_loss_db;   ///< source at 1 m to target, target at 1 m to array [dB]
  std::vector<float> delay;             ///< of the loudest pair of paths [s]
  std::vector<float> reverberation_db;  ///< in the beam, at the echo's time [dB re 1 µPa]
  std::vector<float> noise_db;          ///< in the beam, in the −40 dB band [dB re 1 µPa]
  std::vector<float> signal_excess_db;  ///< by signal_excess_db()
  std::vector<float> detection_probability;
  std::vector<float> uncertainty_db;  ///< of the echo level, one standard deviation; ∞: no ray
  std::vector<float> reverberation_uncertainty_db;  ///< the same of its level
  std::vector<std::int8_t> certainty;               ///< CoverageCertainty
};

/// What a sonar sees of the area around it.
struct Coverage {
  CoverageSettings settings;
  std::string transmitter, array;
  double time = 0.0;                                    ///< of the ping [s]
  double frequency = 0.0;                               ///< centre of the pulse [Hz]
  Vec3 source = Vec3::Zero(), receiver = Vec3::Zero();  ///< [m]
  std::vector<double> bearings;     ///< of the cells' middles, clockwise from north [rad]
  std::vector<double> ranges;       ///< of the cells' middles, from the array [m]
  std::vector<float> bottom_depth;  ///< [bearings × ranges] [m]
  MatchedFilterGain gain;
  double threshold_db = 0.0;  ///< DT
  double source_level_db = 0.0;
  Bounces followed;
  int planes = 1;                     ///< vertical planes that were traced
  std::vector<CoverageLayer> layers;  ///< [depths]
  std::vector<std::string> warnings;
};

/// The level of a standard target's echo, of reverberation and of noise, signal excess and
/// probability of detection over bearing and range around an array.
///
/// One fan of rays in each vertical plane gives the paths to all ranges at the target's depth and
/// at whatever scatters; one plane serves all bearings of a layered ocean. Echo: the mean over the
/// cell of |Σ_pairs A_out·D·A_back·R(τ)|² at the delay at which it is greatest, R the pulse's
/// autocorrelation. Reverberation: that of all bearings through the beam that looks at the echo.
/// Everything is where it is when the ping is sent; Doppler shifts are those of what rests.
/// docs/theory/coverage.md \throws InputError naming the setting at fault
[[nodiscard]] Coverage coverage(const PingSimulator& simulator, const CoverageSettings& settings,
                                const Progress& progress = {});

/// What coverage() takes at its peak.
[[nodiscard]] MemoryNeed coverage_need(const PingSimulator& simulator,
                                       const CoverageSettings& settings);

}  // namespace asdic::detail
