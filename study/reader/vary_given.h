#pragma once
#include "study/reader/vary_laws.h"

namespace asdic::detail::study {

/// given = "season", laws = { winter = { law = .. }, .. }: a law for each value of another input,
/// or for each interval between `edges`. \throws InputError
[[nodiscard]] ConditionalLaw read_conditional(TomlTable& table, const TomlValue& value,
                                              Variable& variable, const Study& study,
                                              const Others& others);

/// law = "expression": a formula of what other inputs draw. \throws InputError
[[nodiscard]] ExpressionLaw read_expression(TomlTable& table, Variable& variable,
                                            const Others& others);

}  // namespace asdic::detail::study
