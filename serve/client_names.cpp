#include "serve/client_names.h"

#include <algorithm>

#include "io/scenario/catalogue.h"

namespace asdic::detail::serve {
namespace {

/// What commands say in place of the beginning of a scenario's path.
struct Wording {
  std::string_view path, name;
  bool of_a_ping = false;
  [[nodiscard]] bool begins(std::string_view whole) const {
    const bool part = path.ends_with('.') || path.ends_with('_');
    return whole == path ||
           (whole.starts_with(path) && (part || whole.substr(path.size()).starts_with('.')));
  }
};
/// In the order in which messages name it. The rest comes after it, by the last word of its path.
constexpr Wording wordings[] = {{"platform", "platform"},
                                {"array", "array"},
                                {"target", "targets"},
                                {"environment.", ""},
                                {"noise", "noise"},
                                {"seed", "seed"},
                                {"pings.recording_", "recording."},
                                {"pulse", "waveform", true},
                                {"transmitter.pulse", "waveform", true},
                                {"transmitter.", "", true}};

const Wording* wording_of(std::string_view path) {
  return std::find_if(std::begin(wordings), std::end(wordings),
                      [&](const Wording& one) { return one.begins(path); });
}

/// \param path  of a setting or a table that is live: "target[].position"
ClientName client_name(std::string path, bool is_table) {
  const std::size_t list = path.find("[]");
  if (list != std::string::npos) path.erase(list, 2);
  const Wording* words = wording_of(path);
  const bool known = words != std::end(wordings);
  const bool of_a_ping = known && words->of_a_ping;
  if (list != std::string::npos && !of_a_ping) {
    path.erase(list);
    return {.section = path, .name = known ? std::string(words->name) : path, .is_list = true};
  }
  ClientName made{.section = path, .name = path.substr(path.rfind('.') + 1)};
  if (known) made.name = std::string(words->name) + path.substr(words->path.size());
  made.of_a_ping = of_a_ping;
  made.is_table = is_table;
  return made;
}

}  // namespace

std::vector<ClientName> client_names_of(const SettingsList& list) {
  std::vector<ClientName> names;
  const auto add = [&](const auto& records, bool are_tables) {
    for (const auto& one : records) {
      if (!one.live) continue;
      ClientName made = client_name(one.path, are_tables);
      const bool again = std::any_of(names.begin(), names.end(), [&](const ClientName& other) {
        return other.section == made.section;
      });
      if (!again) names.push_back(std::move(made));
    }
  };
  add(list.settings, false);
  add(list.tables, true);
  std::stable_sort(names.begin(), names.end(), [](const ClientName& a, const ClientName& b) {
    return wording_of(a.section) < wording_of(b.section);
  });
  return names;
}

const std::vector<ClientName>& client_names() {
  static const std::vector<ClientName> names = client_names_of(scenario::catalogue());
  return names;
}

std::vector<std::string> live_keys(std::string_view table) {
  std::vector<std::string> keys;
  const SettingsList list = below(scenario::catalogue(), table);
  for (const SettingRecord& one : list.settings)
    if (one.live && one.path.find('.') == std::string::npos &&
        std::find(keys.begin(), keys.end(), one.path) == keys.end())
      keys.push_back(one.path);
  return keys;
}

std::string update_keys() {
  std::vector<std::string> keys;
  for (const ClientName& one : client_names())
    if (!one.of_a_ping && (keys.empty() || keys.back() != one.head())) keys.push_back(one.head());
  std::string text = keys.front();
  for (std::size_t i = 1; i < keys.size(); ++i)
    text += (i + 1 == keys.size() ? " or " : ", ") + keys[i];
  return text;
}

SettingRecord as_a_change(SettingRecord record, const std::string& key) {
  record.path = key;
  record.live = record.required = false;  // what is not said goes on as it was
  record.standard.clear();
  record.otherwise.clear();
  record.condition.clear();
  return record;
}

SettingsList update_settings() {
  SettingsList list;
  const auto add = [&](const SettingRecord& record, const std::string& path) {
    const bool again =
        std::any_of(list.settings.begin(), list.settings.end(), [&](const auto& other) {
          return other.path == path && domain_of(other) == domain_of(record);
        });
    if (!again) list.settings.push_back(as_a_change(record, path));
  };
  for (const ClientName& one : client_names()) {
    if (one.of_a_ping) continue;
    for (const SettingRecord* setting : scenario::settings_at(one.section)) add(*setting, one.name);
    for (const SettingRecord& setting : below(scenario::catalogue(), one.section).settings)
      if (setting.live) add(setting, one.name + "[]." + setting.path);
  }
  return list;
}

}  // namespace asdic::detail::serve
