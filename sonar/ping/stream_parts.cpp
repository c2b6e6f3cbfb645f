#include "sonar/ping/stream_parts.h"

#include <algorithm>
#include <cmath>

#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail {

std::vector<std::size_t> stream_parts(const Scenario& scenario) {
  const std::vector<Transmission> sent = transmissions(scenario);
  const Recording recording = recording_of(scenario);
  std::vector<std::size_t> parts;
  for (std::size_t i = 0; i + 1 < sent.size(); ++i)
    parts.push_back(static_cast<std::size_t>(
        std::llround((sent[i + 1].time - sent[i].time) * recording.sample_rate)));
  parts.push_back(recording.samples);
  return parts;
}

std::size_t longest_stream_part(const Scenario& scenario) {
  const std::vector<std::size_t> parts = stream_parts(scenario);
  return *std::max_element(parts.begin(), parts.end());
}

}  // namespace asdic::detail
