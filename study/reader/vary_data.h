#pragma once
#include "io/text/toml_table.h"
#include "study/plan/study.h"
#include "study/sampling/variable.h"

namespace asdic::detail::study {

/// law = "table": rows of a CSV or netCDF file, drawn whole. \throws InputError
[[nodiscard]] TableLaw read_table_law(TomlTable& table, const TomlValue& value,
                                      const Variable& variable, const Study& study, bool in_branch);

/// law = "time_series": rows in the order of time, at a time drawn evenly. \throws InputError
[[nodiscard]] TimeSeriesLaw read_time_series(TomlTable& table, const TomlValue& value,
                                             const Variable& variable, const Study& study);

}  // namespace asdic::detail::study
