#include "serve/client_names.h"

#include <algorithm>
#include <array>

#include "io/scenario/catalogue.h"

namespace asdic::detail::serve {

std::span<const ClientName> client_names() {
  static constexpr std::array<ClientName, 14> names{
      {{"platform", "platform"},
       {"array", "array"},
       {"target", "targets"},
       {"environment.wind_speed", "wind_speed"},
       {"environment.sound_speed", "sound_speed"},
       {"noise", "noise"},
       {"seed", "seed"},
       {"pings.recording_duration", "recording.duration"},
       {"pings.recording_start", "recording.start"},
       {"pulse", "waveform", true},
       {"transmitter.pulse", "waveform", true},
       {"transmitter.elevation_deg", "elevation_deg", true},
       {"transmitter.beamwidth_deg", "beamwidth_deg", true},
       {"transmitter.source_level_db", "source_level_db", true}}};
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
    if (std::string key(one.name.substr(0, one.name.find('.')));
        !one.of_a_ping && (keys.empty() || keys.back() != key))
      keys.push_back(std::move(key));
  std::string text = keys.front();
  for (std::size_t i = 1; i < keys.size(); ++i)
    text += (i + 1 == keys.size() ? " or " : ", ") + keys[i];
  return text;
}

SettingsList update_settings() {
  SettingsList list;
  for (const ClientName& one : client_names()) {
    if (one.of_a_ping) continue;
    const auto add = [&](SettingRecord record, const std::string& path) {
      record.path = path;
      record.live = record.required = false;  // what is not said goes on as it was
      record.standard.clear();
      record.otherwise.clear();
      record.condition.clear();
      const bool again =
          std::any_of(list.settings.begin(), list.settings.end(), [&](const auto& other) {
            return other.path == record.path && domain_of(other) == domain_of(record);
          });
      if (!again) list.settings.push_back(std::move(record));
    };
    for (const SettingRecord* setting : scenario::settings_at(one.section))
      add(*setting, std::string(one.name));
    for (const SettingRecord& setting : below(scenario::catalogue(), one.section).settings)
      if (setting.live) add(setting, std::string(one.name) + "[]." + setting.path);
  }
  return list;
}

}  // namespace asdic::detail::serve
