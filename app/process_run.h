#pragma once
#include <functional>
#include <optional>

#include "io/processing/recordings.h"
#include "io/processing/results.h"

namespace asdic::app {

/// Every ping (or one) of a file through the receiver, array by array, and the tracks over them.
/// \param done  told how many pings are done   \param proceed  false stops
/// \throws Interrupted
[[nodiscard]] ProcessedRun process_file(const PingRecordings& recordings,
                                        const PingProcessor& processor, std::optional<int> ping,
                                        const std::function<void(int)>& done,
                                        const std::function<bool()>& proceed);

}  // namespace asdic::app
