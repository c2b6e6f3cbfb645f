#pragma once
#include <string>

#include "io/processing/results.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::app {

/// What people want to know of a processed file. \param seconds  that it took
[[nodiscard]] std::string process_report(const ProcessedRun& run, const Scenario& scenario,
                                         double seconds);
/// The same for programs (docs/guide/processing.md).
[[nodiscard]] std::string process_json(const ProcessedRun& run, const Scenario& scenario,
                                       const std::string& file);

}  // namespace asdic::detail::app
