#include <algorithm>
#include <cstdio>

#include "sonar/scenario/sampling.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

/// What is recorded [Hz].
Band recorded_band(const Scenario& scenario) {
  const double rate = recorded_rate(scenario);
  if (scenario.pings.samples != Samples::baseband) return {0.0, 0.5 * rate};
  const double carrier = recorded_carrier(scenario);
  return {std::max(0.0, carrier - 0.5 * rate), carrier + 0.5 * rate};
}

}  // namespace

std::string noise_table_band(const Scenario& scenario) {
  if (!scenario.noise.law) return "";
  const auto* table = std::get_if<NoiseTable>(&*scenario.noise.law);
  if (table == nullptr) return "";
  const double first = table->frequency.front(), last = table->frequency.back();
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const Band recorded = recorded_band(scenario);
  const double inside = std::min(last, recorded.highest) - std::max(first, recorded.lowest);
  constexpr double most_outside = 0.05;  // of the recorded band: its first Hz are in no table
  const bool received = pulse.lowest >= first && pulse.highest <= last;
  if (received && inside >= (1.0 - most_outside) * (recorded.highest - recorded.lowest)) return "";
  char text[256];
  std::snprintf(text, sizeof text,
                "noise: levels from %g to %g Hz stand for %s from %g to %g Hz; beyond their ends "
                "the first and last level are held",
                first, last, received ? "a recorded band" : "a pulse",
                received ? recorded.lowest : pulse.lowest,
                received ? recorded.highest : pulse.highest);
  return text;
}

}  // namespace asdic::detail::checks
