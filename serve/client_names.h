#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/settings_catalogue.h"

namespace asdic::detail::serve {

/// What a scenario calls something that a client may change, and what commands call it.
struct ClientName {
  std::string section;     ///< "environment.wind_speed"
  std::string name;        ///< "wind_speed"; "recording.start" is a key of a table
  bool of_a_ping = false;  ///< by the command `ping`, for one ping alone; else by `update`
  bool is_list = false;    ///< of things, each with live keys of its own: "platform"
  bool is_table = false;   ///< taken as a whole: "noise"

  [[nodiscard]] std::string head() const { return name.substr(0, name.find('.')); }
};

/// All that descriptions of settings call `live`, in the order in which messages name it.
[[nodiscard]] std::vector<ClientName> client_names_of(const SettingsList& list);
/// Of a scenario.
[[nodiscard]] const std::vector<ClientName>& client_names();

/// Keys of a scenario's table, "array", that a command may give: those that are live.
[[nodiscard]] std::vector<std::string> live_keys(std::string_view table);

/// The keys of the command `update`, in a sentence: "platform, array or seed".
[[nodiscard]] std::string update_keys();

/// A setting of the scenario as a key of a command, which need not say it.
[[nodiscard]] SettingRecord as_a_change(SettingRecord record, const std::string& key);

/// The keys of the command `update`, as the manual lists them: of sections that it replaces as a
/// whole, the section alone is not among them.
[[nodiscard]] SettingsList update_settings();

}  // namespace asdic::detail::serve
