#pragma once
#include "io/text/toml_table.h"
#include "sonar/scenario/scenario.h"
#include "study/plan/measure_plan.h"

namespace asdic::detail::study {

/// [measure]. \param scenario  of any realisation: its pings, arrays and phones   \throws
/// InputError
[[nodiscard]] MeasurePlan read_measure(TomlTable table, const Scenario& scenario);

}  // namespace asdic::detail::study
