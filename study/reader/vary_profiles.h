#pragma once
#include "io/text/toml_table.h"
#include "study/plan/study.h"
#include "study/sampling/variable.h"

namespace asdic::detail::study {

/// law = "profile_eof": the scenario's profile and modes of it, each with a normal amplitude.
/// \throws InputError
[[nodiscard]] ModesLaw read_modes(TomlTable& table, const Study& study);

/// law = "profile_casts": whole profiles, one of which is drawn.
[[nodiscard]] ChoiceLaw read_casts(TomlTable& table, const TomlValue& value,
                                   const Variable& variable, const Study& study);

/// The key that these laws write, where [vary] names none of its own.
inline constexpr const char* profile_key = "environment.sound_speed";

}  // namespace asdic::detail::study
