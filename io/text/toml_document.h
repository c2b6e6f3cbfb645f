#pragma once
#include <string>

#include "io/text/toml_value.h"

namespace asdic::detail {

/// A whole document as TOML text, table by table. parse_toml() makes the same values of it: numbers
/// read back as the same bits, but one that is whole may come back as an integer.
[[nodiscard]] std::string toml_text(const TomlValue& document);

}  // namespace asdic::detail
