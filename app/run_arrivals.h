#pragma once
#include <string>
#include <vector>

#include "app/command.h"
#include "app/output.h"
#include "raytrace/propagation.h"

namespace asdic::detail::app {

/// Arrivals of a run of the propagation model, at all of its receivers.
struct RunArrivals {
  ResultOrigin origin{};
  PropagationCase run_case{};
  PropagationResult result{};
};

/// Reads a scenario with [run] and finds the arrivals; Ctrl-C ends it. \throws InputError, RunError
[[nodiscard]] RunArrivals find_run_arrivals(const ScenarioChoice& choice,
                                            const std::vector<std::string>& more_overrides);

[[nodiscard]] std::string run_arrivals_table(const RunArrivals& arrivals);
/// docs/formats/arrivals.md
[[nodiscard]] std::string run_arrivals_json(const RunArrivals& arrivals);
/// HDF5 (docs/formats/arrivals.md) or, by the name's ending, .arr. \throws RunError
void write_run_arrivals(OutputFile&& to, const RunArrivals& arrivals);

}  // namespace asdic::detail::app
