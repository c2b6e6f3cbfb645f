#pragma once
#include <string>
#include <vector>

#include "io/scenario/propagation.h"
#include "library/access.h"
#include "raytrace/propagation.h"

namespace asdic {

/// The run of the propagation model that a scenario describes. \param notes  grows
[[nodiscard]] detail::PropagationCase run_case_of(const Scenario& scenario,
                                                  std::vector<std::string>& notes);

/// Runs it within the scenario's memory. \throws detail::InputError naming the scenario's own key
[[nodiscard]] detail::PropagationResult run_of(const Scenario& scenario,
                                               const detail::PropagationCase& run_case);

}  // namespace asdic
