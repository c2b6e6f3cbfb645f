#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings_catalogue.h"

namespace asdic::detail::serve {

/// What a scenario calls something that a client may change, and what commands call it.
struct ClientName {
  std::string_view section;  ///< "environment.wind_speed"
  std::string_view name;     ///< "wind_speed"
  bool of_a_ping = false;    ///< by the command `ping`, for one ping alone; else by `update`
};

/// Which of them there are follows from the descriptions of settings: they are `live` there.
[[nodiscard]] std::span<const ClientName> client_names();

/// Keys of a scenario's table, "array", that a command may give: those that are live.
[[nodiscard]] std::vector<std::string> live_keys(std::string_view table);

/// The keys of the command `update`, in a sentence: "platform, array or seed".
[[nodiscard]] std::string update_keys();

/// The keys of the command `update`, as the manual lists them: of sections that it replaces as a
/// whole, the section alone is not among them.
[[nodiscard]] SettingsList update_settings();

}  // namespace asdic::detail::serve
