#pragma once
#include "sonar/scenario/scenario.h"

namespace asdic::detail::serve {

/// Where straight lines end: just inside of what a scenario's coordinates may be (1e7 m) [m].
inline constexpr double farthest = 9.99e6;

/// Everything that sends, receives or reflects is in the water from the ping to the end of its
/// record, and no target is within 1 m of the transmitter when it is sent. \param ping  its number;
/// \param transmitter  an index; \param time  when it is sent [s] \throws Refusal ("scenario")
void check_places(const Scenario& scenario, int ping, int transmitter, double time);

}  // namespace asdic::detail::serve
