#pragma once
#include <functional>
#include <optional>

#include "io/processing/results.h"
#include "processing/received_pings.h"

namespace asdic::detail {

/// Every ping (or one) through the receiver, array by array, and the tracks over them.
/// \param done  told how many pings are done   \param proceed  false stops
/// \throws Interrupted
[[nodiscard]] ProcessedRun process_pings(const ReceivedPings& recordings,
                                         const PingProcessor& processor, std::optional<int> ping,
                                         const std::function<void(int)>& done,
                                         const std::function<bool()>& proceed);

}  // namespace asdic::detail
