#pragma once
#include <string>
#include <vector>

#include "io/text/toml_table.h"
#include "study/measures/realisation.h"
#include "study/plan/study.h"

namespace asdic::detail::study {

/// [rare] but for its event, and what the inputs have of `proposal`: from where rows are drawn.
/// \param head  [study]   \param table  [rare], which may be absent   \throws InputError
void read_proposals(TomlTable& head, TomlTable& table, Study& study);

/// Its event, once it is known what rows hold. \throws InputError
void read_event(TomlTable& table, const std::vector<Column>& columns, Study& study);

}  // namespace asdic::detail::study
