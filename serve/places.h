#pragma once
#include "sonar/scenario.h"

namespace asdic::serve {

/// Everything that sends, hears or reflects is in the water from the ping to the end of its record,
/// and no target is within 1 m of the transmitter when it is sent.
/// \param ping  its number; \param transmitter  an index; \param time  when it is sent [s]
/// \throws Refusal ("scenario")
void check_places(const Scenario& scenario, int ping, int transmitter, double time);

}  // namespace asdic::serve
