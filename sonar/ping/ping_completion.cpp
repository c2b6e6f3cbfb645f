// What a record gets that does not come of a ping (PingSimulator::complete).
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "sonar/ping/ping.h"
#include "sonar/ping/stopwatch.h"

namespace asdic::detail {

/// Noise and ships at the phones in samples first … of a record that may lie outside of it.
std::vector<float> PingSimulator::surroundings(const PingRecord& record, std::int64_t first,
                                               std::int64_t samples) const {
  PingRecord part;
  part.ping = record.ping;
  part.start_time = record.start_time;
  part.recording = record.recording;
  part.recording.samples = static_cast<std::size_t>(samples);
  part.phones = record.phones;
  part.pressure.assign(part.phones.size() * part.recording.samples * part.recording.components(),
                       0.0F);
  interference_.add(part.samples(), first);
  noise_.add(part.samples(), first);
  return std::move(part.pressure);
}

void PingSimulator::complete(PingRecord& record, ReceiverElectronics::Carried* carried) const {
  Stopwatch watch;
  if (receivers_.is_flat()) {
    record.interference = interference_.add(record.samples());
    noise_.add(record.samples());
  } else {  // the sound of the ping has passed the receivers; this has to as well
    std::vector<float> received =
        std::exchange(record.pressure, std::vector<float>(record.pressure.size(), 0.0F));
    const auto ahead = static_cast<std::int64_t>(receivers_.ahead(record.recording));
    ReceiverElectronics::Carried own;
    if (carried == nullptr) carried = &own;
    if (carried->empty()) *carried = surroundings(record, -ahead, 2 * ahead);
    record.interference = interference_.add(record.samples(), ahead);
    noise_.add(record.samples(), ahead);
    receivers_.respond(record.pressure, record.recording, *carried);
    std::transform(received.begin(), received.end(), record.pressure.begin(),
                   record.pressure.begin(), std::plus<>{});
  }
  if (scenario_.pings.blanking) blank(record);
  receivers_.convert(record.pressure, record.recording);
  record.timings.noise += watch.lap();
}

/// Nothing is received on a platform while one of its transmitters sends: this ping's own or, in a
/// stream, that of any other ping that falls into this part of it.
void PingSimulator::blank(PingRecord& record) const {
  const Recording& recording = record.recording;
  const std::size_t width = recording.components(), row = recording.samples * width;
  const auto sample = [&](double since) {  // the first one from then on
    return static_cast<std::ptrdiff_t>(
        std::ceil(std::clamp((since - recording.start) * recording.sample_rate, 0.0,
                             static_cast<double>(recording.samples))));
  };
  const auto silence = [&](int transmitter, double since) {
    const std::ptrdiff_t begin = sample(since), end = sample(since + pulse(transmitter).duration());
    const int carrier = scenario_.transmitters[static_cast<std::size_t>(transmitter)].platform;
    for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
      if (scenario_.arrays[a].platform != carrier) continue;
      const std::size_t first = first_channel(scenario_, static_cast<int>(a));
      for (std::size_t n = 0; n < scenario_.arrays[a].phones.size(); ++n) {
        const auto channel =
            record.pressure.begin() + static_cast<std::ptrdiff_t>((first + n) * row);
        std::fill(channel + begin * static_cast<std::ptrdiff_t>(width),
                  channel + end * static_cast<std::ptrdiff_t>(width), 0.0F);
      }
    }
  };
  silence(record.transmitter, 0.0);
  if (!scenario_.pings.continuous) return;  // such a record receives no other ping
  double longest = 0.0;
  for (std::size_t t = 0; t < scenario_.transmitters.size(); ++t)
    longest = std::max(longest, pulse(static_cast<int>(t)).duration());
  const double received = static_cast<double>(recording.samples) / recording.sample_rate;
  const auto since = [&](const Transmission& sent) { return sent.time - record.start_time; };
  const auto own = transmissions_.begin() + (record.ping - 1);
  for (auto sent = own; sent != transmissions_.begin() && since(*std::prev(sent)) > -longest;) {
    --sent;
    silence(sent->transmitter, since(*sent));
  }
  for (auto sent = std::next(own); sent != transmissions_.end() && since(*sent) < received; ++sent)
    silence(sent->transmitter, since(*sent));
}

}  // namespace asdic::detail
