#pragma once
#include <vector>

#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// One ping of one transmitter.
struct Transmission {
  int transmitter = 0;     ///< index in the scenario
  int own_ping = 1;        ///< which of its own pings, from 1
  double time = 0.0;       ///< of the leading edge, since the start of the scenario [s]
  double elevation = 0.0;  ///< of the beam [rad]
};

/// All pings of all transmitters in the order in which they are sent (of two at one time the first
/// transmitter's comes first): ping n of a run is element n − 1. \return [count × transmitters]
[[nodiscard]] std::vector<Transmission> transmissions(const Scenario& scenario);

/// The transmitter as it is for that ping: with its elevation.
[[nodiscard]] Transmitter projector_of(const Scenario& scenario, const Transmission& sent);
/// The same of a ping out of a file. One that was sent on command may have a number of the schedule
/// and another transmitter: then, and beyond the schedule's end, with the elevation of its own.
/// \param transmitter  index   \param ping  counted from 1
[[nodiscard]] Transmitter projector_of(const Scenario& scenario, int transmitter, int ping);

}  // namespace asdic::detail
