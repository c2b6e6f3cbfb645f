#include "serve/ping_request.h"

#include <algorithm>

#include "core/quantities.h"
#include "core/settings_catalogue.h"
#include "io/scenario/catalogue.h"
#include "io/settings/reader.h"
#include "io/text/toml_table.h"
#include "io/text/toml_value.h"
#include "serve/client_names.h"
#include "serve/client_value.h"
#include "serve/update.h"

namespace asdic::detail::serve {
namespace {

int transmitter_of(TomlTable& reader, const Scenario& scenario) {
  const std::string name = reader.text("transmitter");
  const auto& all = scenario.transmitters;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  if (found == all.end()) throw reader.fault("transmitter", "the name of a transmitter");
  return static_cast<int>(found - all.begin());
}

/// What descriptions of the scenario call live and a ping has of its own. But for the elevation: it
/// is the request's, since pings take turns at theirs.
std::vector<ClientName> own_settings() {
  std::vector<ClientName> own;
  const SettingsList described = catalogue_of<PingRequest>();
  for (const ClientName& one : client_names()) {
    const auto is_same = [&](const auto& other) {
      return other.name == one.name;  // "waveform", of all transmitters or of one
    };
    const bool here = std::any_of(described.settings.begin(), described.settings.end(),
                                  [&](const auto& setting) { return setting.path == one.name; });
    if (one.of_a_ping && !here && std::none_of(own.begin(), own.end(), is_same)) own.push_back(one);
  }
  return own;
}

PingRequest read(const TomlValue& fields, const LiveScenario& live, const SessionLimits& limits,
                 Delivery usual) {
  TomlTable reader(fields);
  PingRequest ping;
  if (reader.has("transmitter")) ping.transmitter = transmitter_of(reader, live.state().scenario);
  ping.deliver = usual;
  KnownSettings known;
  TomlReader walker(reader, known);
  ping.describe(walker);
  for (const ClientName& one : own_settings())
    if (auto value = client_value(reader, fields, one.name, one, live.data(), limits))
      ping.changes.values.emplace_back(one.name, std::move(*value));
  if (ping.deliver == Delivery::file && usual != Delivery::file)
    throw reader.fault("deliver", "\"samples\" or \"none\": the server has no --output-dir");
  if (ping.replica && ping.deliver == Delivery::file)
    throw reader.fault("replica", "false with \"deliver\": \"file\": files have it");
  reader.finish();
  return ping;
}

}  // namespace

void PingRequest::describe(Fields& field) {
  field("time", time, quantity::time, "of the scenario; default: the schedule's, or the clock's");
  field("elevation", elevation, quantity::elevation,
        "of the beam, positive up; default: the scenario's");
  field("deliver", deliver, "where the samples go; default: a file, if the server writes any");
  field("replica", replica, "whether the pulse follows, after the samples, for a matched filter");
}

SettingsList ping_settings() {
  SettingsList list = catalogue_of<PingRequest>();
  for (const ClientName& one : own_settings())
    for (const SettingRecord* setting : scenario::settings_at(one.section))
      list.settings.push_back(as_a_change(*setting, one.name));
  return list;
}

PingRequest read_ping(const TomlValue& fields, const LiveScenario& live,
                      const SessionLimits& limits, Delivery usual) {
  try {
    return read(fields, live, limits, usual);
  } catch (const InputError& error) {
    throw refusal_of_value(error);
  }
}

}  // namespace asdic::detail::serve
