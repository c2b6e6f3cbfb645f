#pragma once
#include <vector>

#include "sonar/ping.h"
#include "study/realisation.h"
#include "study/study.h"

namespace asdic::study {

/// The columns of a study's measures.
[[nodiscard]] std::vector<Column> measure_columns(const Study& study, const Scenario& scenario);

/// Simulates the ping of one realisation's scenario and measures it. \return [measure columns]
[[nodiscard]] std::vector<double> measure(const Study& study, Scenario scenario);

}  // namespace asdic::study
