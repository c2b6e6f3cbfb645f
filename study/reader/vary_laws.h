#pragma once
#include <vector>

#include "io/text/toml_table.h"
#include "study/plan/study.h"
#include "study/sampling/variable.h"

namespace asdic::detail::study {

/// Variables that are read already: a law may look at what they draw.
using Others = std::vector<const Variable*>;

/// The law of one entry of [vary]. \param table, value  the entry   \param variable  with its keys;
/// its `given` is filled   \param study  whose scenario gives what the law leaves open
/// \throws InputError
[[nodiscard]] AnyLaw read_law(TomlTable& table, const TomlValue& value, Variable& variable,
                              const Study& study, const Others& others, bool in_branch = false);

/// `proposal` of an entry: a law, or weights of its choices, from which it is drawn instead.
/// \throws InputError
[[nodiscard]] CoordinateDraw read_proposal(TomlTable& table, const AnyLaw& law);

/// Names of the columns that an entry's law looks at, known or not.
[[nodiscard]] std::vector<std::string> looked_at(const TomlValue& entry);

}  // namespace asdic::detail::study
