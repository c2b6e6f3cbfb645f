#pragma once
#include "io/text/toml_table.h"
#include "study/plan/study.h"
#include "study/sampling/variable.h"

namespace asdic::detail::study {

/// law = "climatology": the sound speed of a month, at a place, of files with monthly means
/// (docs/guide/real-ocean.md). \param variable  its digest and notes are filled
/// \throws InputError
[[nodiscard]] ChoiceLaw read_climatology(TomlTable& table, const TomlValue& value,
                                         Variable& variable, const Study& study);

}  // namespace asdic::detail::study
