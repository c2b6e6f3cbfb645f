#pragma once
#include "io/text/toml_table.h"
#include "study/measures/realisation.h"
#include "study/plan/summary_plan.h"

namespace asdic::detail::study {

/// [summary]. \param value  the table itself, or null   \param of_rows  columns, which axes
/// name   \throws InputError
[[nodiscard]] SummaryPlan read_summary(TomlTable table, const TomlValue* value,
                                       const std::vector<Column>& of_rows);

}  // namespace asdic::detail::study
