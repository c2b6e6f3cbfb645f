#pragma once
#include <vector>

#include "io/text/toml_table.h"
#include "study/plan/summary_plan.h"
#include "study/summary/table.h"

namespace asdic::detail::study {

/// [summary.own]: measures that are formulae of a row's columns, and of one another.
/// \param value  the table itself   \param columns  of the rows   \throws InputError
[[nodiscard]] std::vector<OwnFormula> read_own(TomlTable table, const TomlValue& value,
                                               const std::vector<Column>& columns);

}  // namespace asdic::detail::study
