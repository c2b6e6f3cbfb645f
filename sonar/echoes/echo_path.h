#pragma once
#include <complex>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "sonar/paths/delay_curve.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/paths/returns.h"
#include "sonar/signal/band_response.h"

namespace asdic::detail {

struct MetLeg;

/// One of the paths of a leg (sonar/echoes/leg_response.h).
struct PathOnLeg {
  std::shared_ptr<const MetLeg> leg;
  std::size_t path = 0;
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
  Return received;        ///< at the array's reference point (or the phone)
  PathResponse response;  ///< for other frequencies than the pulse's centre
  /// Legs of the echo, each to where its path was met; empty if the centre's amplitude serves the
  /// whole band.
  std::vector<PathOnLeg> legs = {};
  std::complex<double> glint = 1.0;      ///< what the target's place makes of the pressure
  std::optional<DelayCurve> curve = {};  ///< where a constant Doppler factor is not enough
};

/// The echoes of a target at an array where pairs of paths are too many to be taken one by one: the
/// loudest alone are listed, all are received (sonar/echoes/two_step_echo.h).
struct ManyEchoes {
  int target = 0;          ///< index in the scenario
  int array = 0;           ///< index in the scenario
  std::size_t pairs = 0;   ///< of paths, that are received before the record ends
  double first = 0.0;      ///< when the first of their leading edges is received …
  double last = 0.0;       ///< … and the last [s]
  bool at_phones = false;  ///< every phone receives paths of its own
  Bounces followed;        ///< on either leg
  double peak = 0.0;       ///< largest envelope at the reference point, over the pulse's at 1 m
};

}  // namespace asdic::detail
