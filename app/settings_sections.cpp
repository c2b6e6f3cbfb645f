#include "app/settings_sections.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "io/scenario/catalogue.h"
#include "processing/ping_processor.h"
#include "serve/client_names.h"
#include "serve/listen_request.h"
#include "serve/ping_request.h"
#include "serve/session_limits.h"
#include "serve/sound_request.h"

namespace asdic::detail::app {
namespace {

SettingsList of_scenario(std::string_view path) { return below(scenario::catalogue(), path); }

/// The keys of a scenario that are in no table.
SettingsList keys_of_scenario(std::string_view /*path*/) {
  SettingsList list{.settings = scenario::catalogue().settings};
  std::erase_if(list.settings,
                [](const auto& one) { return one.path.find('.') != std::string::npos; });
  return list;
}

template <Described T>
SettingsList of_struct(std::string_view /*path*/) {
  return catalogue_of<T>();
}

SettingsSection in_scenario(std::string path, std::string title) {
  return {"scenario", std::move(path), std::move(title), of_scenario};
}

}  // namespace

std::span<const SettingsSection> settings_sections() {
  static const std::vector<SettingsSection> all{
      {"scenario", std::string(top_level), "the keys before all tables", keys_of_scenario},
      in_scenario("environment", "the water and its boundaries"),
      in_scenario("environment.area", "an ocean over the map"),
      in_scenario("environment.area.seabed.class", "[[…]], what numbers of a map stand for"),
      in_scenario("environment.sound_speed", "of the water"),
      in_scenario("environment.bottom", "below the water"),
      in_scenario("environment.bottom.shape.material", "[[…]], behind the bottom from each node"),
      in_scenario("environment.surface", "above the water"),
      in_scenario("environment.surface.shape.material", "[[…]], behind the surface from each node"),
      in_scenario("pulse", "what is sent"),
      in_scenario("platform", "what carries transmitters and arrays"),
      in_scenario("transmitter", "what sends the pulses"),
      in_scenario("array", "of hydrophones"),
      in_scenario("target", "what sends echoes"),
      in_scenario("interferer", "ships that make noise"),
      in_scenario("noise", "of the sea at the phones"),
      in_scenario("reverberation", "of surface, bottom and water"),
      in_scenario("propagation", "the paths that are searched for"),
      in_scenario("pings", "when pings are sent and how they are recorded"),
      in_scenario("run", "of the propagation model alone"),
      {"study", "measure.receiver", "the receiver, and the options of asdic process",
       of_struct<ProcessingSettings>},
      {"process", "tracks", "options of asdic process for tracks", of_struct<TrackerSettings>},
      {"serve", "ping", "keys of the command ping",
       [](std::string_view) { return serve::ping_settings(); }},
      {"serve", "update", "keys of the command update",
       [](std::string_view) { return serve::update_settings(); }},
      {"serve", "listen", "keys of the command listen",
       [](std::string_view) { return serve::listen_settings(); }},
      {"serve", "arrivals", "keys of the command arrivals", of_struct<serve::ArrivalsRequest>},
      {"serve", "rays", "keys of the command rays", of_struct<serve::RaysRequest>},
      {"serve", "limits", "what a client may ask for: --limit", of_struct<serve::SessionLimits>}};
  return all;
}

std::vector<SettingRecord> SettingsSection::shown() const {
  SettingsList all = list();
  for (const SettingsSection& other : settings_sections()) {
    if (other.document != document || !other.path.starts_with(path + '.')) continue;
    const std::string inner = other.path.substr(path.size() + 1);
    std::erase_if(all.settings, [&](const SettingRecord& one) {
      return one.path.starts_with(inner + '.') || one.path.starts_with(inner + "[].");
    });
  }
  return std::move(all.settings);
}

SettingsSection settings_section(std::string_view path) {
  std::string names;
  for (const SettingsSection& one : settings_sections()) {
    if (one.path == path) return one;
    names += (names.empty() ? "" : ", ") + one.path;
  }
  for (const TableRecord& table : scenario::catalogue().tables) {
    std::string name = table.path;  // "target[].highlight[]" is asked for as target.highlight
    for (auto at = name.find("[]"); at != std::string::npos; at = name.find("[]"))
      name.erase(at, 2);
    if (name == path)
      return {"scenario", table.path.substr(0, table.path.size() - (table.list ? 2 : 0)),
              table.help, of_scenario};
  }
  throw InputError({.where = "SECTION",
                    .got = in_quotes(path),
                    .expected = "one that is described: " + names +
                                "; or a table within one of a scenario, reverberation.surface"});
}

}  // namespace asdic::detail::app
