#pragma once
#include <string>

#include "io/text/toml_value.h"

namespace asdic::serve {

/// A value as TOML on one line: {name = "ship", position = [0, 0, 100]}. Numbers read back as the
/// same bits.
[[nodiscard]] std::string inline_toml(const TomlValue& value);

/// Sets a key of a table, or adds it.
void set_key(TomlValue& table, const std::string& key, TomlValue value);
/// Takes a key out of a table, if it is there.
void erase_key(TomlValue& table, const std::string& key);

}  // namespace asdic::serve
