#include "serve/caps.h"

#include <cmath>
#include <string>

#include "core/text.h"
#include "serve/refusal.h"
#include "sonar/ping/ping_memory.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

void cap(const std::string& what, double got, std::size_t most) {
  if (got <= static_cast<double>(most)) return;
  throw Refusal("limit",
                refusal_text(what, to_text(std::ceil(got)), "at most " + std::to_string(most)));
}

}  // namespace

void check_caps(const Scenario& scenario, const SessionLimits& limits) {
  cap("phones", static_cast<double>(channels_of(scenario)), limits.channels);
  cap("targets", static_cast<double>(scenario.targets.size()), limits.targets);
  const double samples = scenario.pings.recording_duration * recorded_rate(scenario);
  cap("samples of a phone", samples, limits.samples);
  if (scenario.reverberation.enabled)
    cap("reverberation.most_returns", static_cast<double>(scenario.reverberation.most_returns),
        limits.patches);
  cap("bytes of memory for a ping's samples", record_need(scenario, samples).bytes,
      limits.memory_bytes);
}

}  // namespace asdic::detail::serve
