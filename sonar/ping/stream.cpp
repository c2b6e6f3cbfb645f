#include "sonar/ping/stream.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail {
namespace {

std::vector<std::size_t> parts_of(const Scenario& scenario) {
  const std::vector<Transmission> sent = transmissions(scenario);
  const Recording recording = recording_of(scenario);
  std::vector<std::size_t> parts;
  for (std::size_t i = 0; i + 1 < sent.size(); ++i)
    parts.push_back(static_cast<std::size_t>(
        std::llround((sent[i + 1].time - sent[i].time) * recording.sample_rate)));
  parts.push_back(recording.samples);
  return parts;
}

}  // namespace

Stream::Stream(const Scenario& scenario) : parts_(parts_of(scenario)) {}

std::size_t Stream::longest_part(const Scenario& scenario) {
  const std::vector<std::size_t> parts = parts_of(scenario);
  return *std::max_element(parts.begin(), parts.end());
}

void Stream::take(PingRecord& record) {
  if (static_cast<std::size_t>(record.ping) != next_ + 1)
    throw std::logic_error("pings of a stream out of order");
  const std::size_t part = parts_[next_++];
  const std::size_t own = record.recording.samples, width = record.recording.components(),
                    channels = record.phones.size();
  const std::size_t whole = std::max({part, own, waiting_samples_});
  std::vector<float> handed_out(channels * part * width, 0.0F),
      later(channels * (whole - part) * width, 0.0F);
  const auto add = [&](const std::vector<float>& sound, std::size_t samples) {
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const float* from = sound.data() + channel * samples * width;
      float* now = handed_out.data() + channel * part * width;
      float* then = later.data() + channel * (whole - part) * width;
      const std::size_t first = std::min(samples, part) * width;
      for (std::size_t i = 0; i < first; ++i) now[i] += from[i];
      for (std::size_t i = first; i < samples * width; ++i) then[i - first] += from[i];
    }
  };
  add(waiting_, waiting_samples_);
  add(record.pressure, own);
  waiting_ = std::move(later);
  waiting_samples_ = whole - part;
  record.pressure = std::move(handed_out);
  record.recording.samples = part;
}

}  // namespace asdic::detail
