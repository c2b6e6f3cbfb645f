#pragma once
#include <string_view>
#include <vector>

#include "core/settings_catalogue.h"

namespace asdic::detail::scenario {

/// Every setting that a scenario file may have, and its tables: "seed", "environment.bottom.depth",
/// "target[].strength_db". It is made once.
[[nodiscard]] const SettingsList& catalogue();

/// What may stand at a key of --set, "target.0.strength_db" or "array.spacing": of each choice that
/// has it. None: there is no such setting.
[[nodiscard]] std::vector<const SettingRecord*> settings_at(std::string_view key);

/// The only or the first of these. It is there: \param key  of a setting
[[nodiscard]] const SettingRecord& setting_at(std::string_view key);

}  // namespace asdic::detail::scenario
