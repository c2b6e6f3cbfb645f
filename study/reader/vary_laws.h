#pragma once
#include "io/text/toml_table.h"
#include "study/plan/study.h"
#include "study/sampling/variable.h"

namespace asdic::detail::study {

/// The law of one entry of [vary]. \param table, value  the entry   \param variable  with its keys
/// \param study  whose scenario gives what the law leaves open   \throws InputError
[[nodiscard]] AnyLaw read_law(TomlTable& table, const TomlValue& value, const Variable& variable,
                              const Study& study);

}  // namespace asdic::detail::study
