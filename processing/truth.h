#pragma once
#include <span>
#include <vector>

#include "processing/scoring.h"
#include "sonar/ping/ping_record.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// The echoes of a ping that an array receives, as the simulation knows them.
[[nodiscard]] std::vector<TrueEcho> true_echoes(const PingRecord& record, int array);

/// The targets of a ping, each where it was when the loudest of its echoes struck it (without an
/// echo, when the ping was sent). \param start_time  of the ping [s]
[[nodiscard]] std::vector<TrueTarget> true_targets(const Scenario& scenario, int ping,
                                                   double start_time,
                                                   std::span<const TrueEcho> echoes);

}  // namespace asdic::detail
