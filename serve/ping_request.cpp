#include "serve/ping_request.h"

#include <algorithm>

#include "core/quantities.h"
#include "io/scenario/catalogue.h"
#include "io/settings/reader.h"
#include "io/text/toml_table.h"
#include "io/text/toml_value.h"
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

PingRequest read(const TomlValue& fields, const LiveScenario& live, const SessionLimits& limits,
                 Delivery usual) {
  TomlTable reader(fields);
  PingRequest ping;
  if (reader.has("transmitter")) ping.transmitter = transmitter_of(reader, live.state().scenario);
  ping.deliver = usual;
  KnownSettings known;
  TomlReader walker(reader, known);
  ping.describe(walker);
  if (reader.has("waveform")) {
    TomlTable waveform = reader.table("waveform");
    ping.changes.waveform = *fields.find("waveform");
    if (waveform.has("file"))
      set_key(
          *ping.changes.waveform, "file",
          {.data =
               live.data().file(waveform.text("file"), "waveform.file", limits.file_bytes).string(),
           .origin = ""});
  }
  if (ping.deliver == Delivery::file && usual != Delivery::file)
    throw reader.fault("deliver", "\"samples\" or \"none\": the server has no --output-dir");
  reader.finish();
  return ping;
}

}  // namespace

void PingRequest::describe(Fields& field) {
  field("time", time, quantity::time, "of the scenario; default: the schedule's, or the clock's");
  field("elevation", elevation, quantity::elevation,
        "of the beam, positive up; default: the scenario's");
  const auto of_transmitter = [](const std::string& key) {
    return scenario::setting_at("transmitter." + key).quantity;
  };
  field("source_level_db", changes.source_level_db, of_transmitter("source_level_db"),
        "of this ping alone");
  field("beamwidth_deg", changes.beamwidth_deg, of_transmitter("beamwidth_deg"),
        "of this ping alone");
  field("deliver", deliver, "where the samples go; default: a file, if the server writes any");
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
