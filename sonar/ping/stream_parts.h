#pragma once
#include <cstddef>
#include <vector>

#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Into which parts the continuous record of a scenario's pings is cut: each from its ping's start
/// to the start of the next one (of any transmitter), the last as long as its ping is received.
/// \return [pings] samples
[[nodiscard]] std::vector<std::size_t> stream_parts(const Scenario& scenario);

/// Samples of the longest of them.
[[nodiscard]] std::size_t longest_stream_part(const Scenario& scenario);

}  // namespace asdic::detail
