#pragma once
#include "study/reader/vary_laws.h"

namespace asdic::detail::study {

/// given = "season", laws = { winter = { law = .. }, .. }: a law for each value of another input,
/// or for each interval between `edges`. \throws InputError
[[nodiscard]] ConditionalLaw read_conditional(TomlTable& table, const TomlValue& value,
                                              Variable& variable, const Study& study,
                                              const Others& others);

/// Keys of a continuous law that may be formulae of what other inputs draw.
[[nodiscard]] const std::vector<std::string>& parameter_keys();

/// A formula of the numbers that others draw. \param names  of which of Variable::given, in the
/// order of its own \throws InputError
[[nodiscard]] Expression read_formula(TomlTable& table, const std::string& key, Variable& variable,
                                      const Others& others, std::vector<std::size_t>& names);

/// law = "expression": a formula of what other inputs draw. \throws InputError
[[nodiscard]] ExpressionLaw read_expression(TomlTable& table, Variable& variable,
                                            const Others& others);

}  // namespace asdic::detail::study
