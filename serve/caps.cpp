#include "serve/caps.h"

#include <cmath>
#include <string>

#include "io/text/toml_value.h"
#include "serve/refusal.h"
#include "sonar/sampling.h"

namespace asdic::serve {
namespace {

void cap(const std::string& what, double got, std::size_t most) {
  if (got <= static_cast<double>(most)) return;
  throw Refusal("limit",
                refusal_text(what, to_text(std::ceil(got)), "at most " + std::to_string(most)));
}

}  // namespace

double ping_bytes(const Scenario& scenario) {
  const Recording recording = recording_of(scenario);
  // Per sample and phone: the record, the baseband of echoes and of reverberation at no more than
  // the record's rate and twice that length (its overlap), and an FFT's input and output.
  constexpr double baseband = 8.0, transforms = 16.0;
  const double a_sample =
      4.0 * static_cast<double>(recording.components()) + 2.0 * 2.0 * baseband + transforms;
  constexpr double a_return = 72.0;  // bytes (docs/performance.md)
  const double returns =
      scenario.reverberation.enabled
          ? static_cast<double>(scenario.reverberation.most_returns * scenario.arrays.size())
          : 0.0;
  return a_sample * static_cast<double>(recording.samples) *
             static_cast<double>(channels_of(scenario)) +
         a_return * returns;
}

void check_caps(const Scenario& scenario, const SessionLimits& limits) {
  cap("phones", static_cast<double>(channels_of(scenario)), limits.channels);
  cap("targets", static_cast<double>(scenario.targets.size()), limits.targets);
  cap("samples of a phone", scenario.pings.recording_duration * recorded_rate(scenario),
      limits.samples);
  if (scenario.reverberation.enabled)
    cap("reverberation.most_returns", static_cast<double>(scenario.reverberation.most_returns),
        limits.patches);
  cap("bytes of memory for a ping", ping_bytes(scenario), limits.memory_bytes);
}

}  // namespace asdic::serve
