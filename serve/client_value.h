#pragma once
#include <optional>

#include "io/text/toml_table.h"
#include "serve/client_names.h"
#include "serve/data_folder.h"
#include "serve/session_limits.h"

namespace asdic::detail::serve {

/// What a command says of a setting, as it stands; none: nothing. A value of its own is held
/// against the setting's bounds at once, those of a table when the scenario is read with them. A
/// file that a table names is one of the data folder.
/// \param reader  of the command, or of its table in which the key stands   \param key  there
/// \throws InputError, Refusal ("file") naming the command's key
[[nodiscard]] std::optional<TomlValue> client_value(TomlTable& reader, const TomlValue& fields,
                                                    const std::string& key, const ClientName& name,
                                                    const DataFolder& data,
                                                    const SessionLimits& limits);

}  // namespace asdic::detail::serve
