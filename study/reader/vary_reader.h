#pragma once
#include "study/plan/study.h"

namespace asdic::detail::study {

/// [vary]: the variables of a study, in the order in which they stand in the file.
/// \param document  with [vary] in it   \throws InputError
[[nodiscard]] std::vector<Variable> read_vary(const TomlValue& document, const Study& study);

}  // namespace asdic::detail::study
