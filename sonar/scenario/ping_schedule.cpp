#include "sonar/scenario/ping_schedule.h"

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {

void PingSchedule::describe(Fields& field) {
  constexpr Quantity rate{.noun = "sample rate", .unit = "Hz", .low = 0.1, .high = 1e7};
  field("count", count, 1, 1'000'000, "of each transmitter");
  field("interval", interval, quantity::interval, "from ping to ping of one transmitter");
  field(by_default("elevations", "those of the transmitters"), elevations, quantity::elevation,
        "of the transmitter in each ping, repeated as needed");
  if (field.checks() && !elevations.empty() && field.known("transmitter.has_elevation") > 0.0)
    field.fault("elevations", "no elevations_deg beside transmitter.elevation_deg");
  field(live("recording_duration"), recording_duration, quantity::duration,
        "how long each ping is received, from its start");
  field(live("recording_start"), recording_start,
        {.noun = "time", .unit = "s", .low = 0.0, .high = 1e5}, "of a record, after the ping");
  field("samples", samples, "what the samples of the phones are");
  if (const auto only = field.only("samples", samples, Samples::pressure)) {
    field.excludes("samples = \"pressure\"", {"carrier", "baseband_rate"});
    field("sample_rate", sample_rate, rate, "of pressure");
  }
  if (const auto only = field.only("samples", samples, Samples::baseband)) {
    field.excludes("samples = \"baseband\"", {"sample_rate"});
    field(by_default("carrier", "the middle of the pulses"), carrier, quantity::frequency,
          "about which the baseband is");
    field(by_default("baseband_rate", "by the pulses' band with its Doppler shifts"), baseband_rate,
          rate, "of complex samples");
  }
  field("continuous", continuous, "one stream for each phone, without gaps between pings");
  field("blanking", blanking,
        "whether arrays on the transmitter's platform receive nothing while it transmits");
  if (field.checks() && continuous && recording_start > 0.0)
    field.fault("recording_start", "0 in a continuous stream, which has no gaps");
}

}  // namespace asdic::detail
