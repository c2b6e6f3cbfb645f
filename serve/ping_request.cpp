#include "serve/ping_request.h"

#include <algorithm>

#include "core/quantities.h"
#include "io/scenario/sections.h"
#include "io/text/toml_table.h"
#include "io/text/toml_value.h"
#include "serve/update.h"

namespace asdic::serve {
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
  if (reader.has("time"))
    ping.time = reader.number("time", {.noun = "time", .unit = "s", .low = 0.0, .high = 1e9});
  if (reader.has("elevation_deg"))
    ping.elevation = radians(reader.number("elevation_deg", quantity::elevation.in_degrees()));
  if (reader.has("source_level_db"))
    ping.changes.source_level_db = reader.number("source_level_db", quantity::level);
  if (reader.has("beamwidth_deg"))
    ping.changes.beamwidth_deg = reader.number(
        "beamwidth_deg", {.noun = "beamwidth", .unit = "degrees", .low = 0.01, .high = 179.0});
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
  const std::vector<std::string> names{"file", "samples", "none"};
  const std::string deliver =
      reader.choice("deliver", names, names[static_cast<std::size_t>(usual)]);
  ping.deliver =
      static_cast<Delivery>(std::find(names.begin(), names.end(), deliver) - names.begin());
  if (ping.deliver == Delivery::file && usual != Delivery::file)
    throw reader.fault("deliver", "\"samples\" or \"none\": the server has no --output-dir");
  reader.finish();
  return ping;
}

}  // namespace

PingRequest read_ping(const TomlValue& fields, const LiveScenario& live,
                      const SessionLimits& limits, Delivery usual) {
  try {
    return read(fields, live, limits, usual);
  } catch (const InputError& error) {
    throw refusal_of_value(error);
  }
}

}  // namespace asdic::serve
