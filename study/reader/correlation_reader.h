#pragma once
#include "io/text/toml_table.h"
#include "study/plan/study.h"

namespace asdic::detail::study {

/// [correlation]: inputs that depend on one another. \param variables  of the study
/// \throws InputError that names the entries at fault
[[nodiscard]] Correlation read_correlation(TomlTable table, const TomlValue& value,
                                           const std::vector<Variable>& variables);

}  // namespace asdic::detail::study
