#include "sonar/ping/levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "sonar/noise/noise_spectrum.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {

LevelMeter::LevelMeter(const Recording& recording, double pulse_duration)
    : start_(recording.start) {
  const double duration = static_cast<double>(recording.samples) / recording.sample_rate;
  // The mean over fewer than two samples would depend on where they lie.
  series_.time_step =
      std::max({std::min(pulse_duration, 0.05), duration / 20000.0, 2.0 / recording.sample_rate});
  const auto steps = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::ceil(duration / series_.time_step - 1e-9)));
  for (auto* part : {&series_.echo, &series_.reverberation, &series_.noise})
    part->assign(steps, 0.0F);
}

void LevelMeter::add_noise(double variance) {
  for (float& value : series_.noise) value += static_cast<float>(variance);
}

void LevelMeter::add_reverberation(const PingReverberation& sea, double peak_pressure, double share,
                                   PropagationMemory& memory) {
  std::vector<float>& into = series_.reverberation;
  const std::vector<double> power = sea.mean_power(start_, series_.time_step, into.size(), memory);
  for (std::size_t i = 0; i < into.size(); ++i)
    into[i] += static_cast<float>(0.5 * share * peak_pressure * peak_pressure * power[i]);
}

void LevelMeter::add_echo(const Baseband& received, double peak_pressure) {
  if (received.channels == 0) return;
  std::vector<float>& into = series_.echo;
  const auto step_of = [&](std::size_t i) {
    return std::min(into.size() - 1,
                    static_cast<std::size_t>(static_cast<double>(i) / received.sample_rate /
                                             series_.time_step));
  };
  const double step_samples = received.sample_rate * series_.time_step;
  std::array<float, 1024> squares;  // of the channels' real and imaginary parts, added up
  constexpr std::size_t block = squares.size() / 2;
  std::size_t begin = 0, end = 0, step = 0;  // samples of a step
  double power = 0.0;                        // of those so far
  for (std::size_t first = 0; first < received.recorded; first += block) {
    const std::size_t count = std::min(block, received.recorded - first);
    squares.fill(0.0F);
    for (std::size_t n = 0; n < received.channels; ++n) {
      const auto* parts = reinterpret_cast<const float*>(received.channel(n).data() + first);
      for (std::size_t j = 0; j < 2 * count; ++j) squares[j] += parts[j] * parts[j];
    }
    for (std::size_t i = first; i < first + count;) {
      if (i == end) {  // the next step
        begin = i;
        step = step_of(begin);
        end = std::clamp(static_cast<std::size_t>(static_cast<double>(step + 1) * step_samples),
                         begin + 1, received.recorded);
        while (end > begin + 1 && step_of(end - 1) != step) --end;
        while (end < received.recorded && step_of(end) == step) ++end;
        power = 0.0;
      }
      const std::size_t until = std::min(end, first + count);
      for (; i < until; ++i)
        power += static_cast<double>(squares[2 * (i - first)] + squares[2 * (i - first) + 1]);
      // mean square of a tone is half its envelope's square
      if (i == end)
        into[step] += static_cast<float>(0.5 * peak_pressure * peak_pressure * power /
                                         static_cast<double>(received.channels * (end - begin)));
    }
  }
}

std::vector<TargetSummary> summarise(const PingRecord& record, const Scenario& scenario,
                                     const Pulse& pulse, const SummaryParts& parts) {
  std::vector<TargetSummary> summary;
  const double source_level_db =
      scenario.transmitters[static_cast<std::size_t>(record.transmitter)].source_level_db;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const Target& target = scenario.targets[i];
    TargetSummary row{
        .name = target.name,
        .present = record.ping >= target.first_ping && record.ping <= target.last_ping};
    const EchoPath* strongest = nullptr;
    for (const EchoPath& echo : record.echoes)
      if (echo.target == static_cast<int>(i) &&
          (strongest == nullptr || echo.level_db > strongest->level_db))
        strongest = &echo;
    row.echo_level_db = row.echo_peak_db = row.signal_excess_db = -infinity;
    row.echo_time = std::nan("");
    row.reverberation_db = -infinity;
    row.noise_db = noise_band_db(scenario.noise, pulse.centre_frequency(), pulse.bandwidth_40db());
    if (strongest != nullptr) {
      row.array = strongest->array;
      std::vector<EchoPath> received;
      for (const EchoPath& echo : record.echoes) {
        if (echo.target != static_cast<int>(i) || echo.array != row.array) continue;
        ++row.paths;
        if (echo.received.channel == Return::all_channels || echo.received.channel == 0)
          received.push_back(echo);
      }
      for (const EchoPath& part : record.scattered)
        if (part.target == static_cast<int>(i) && part.array == row.array &&
            (part.received.channel == Return::all_channels || part.received.channel == 0))
          received.push_back(part);
      const auto many = std::find_if(
          record.many_echoes.begin(), record.many_echoes.end(), [&](const ManyEchoes& one) {
            return one.target == static_cast<int>(i) && one.array == row.array;
          });
      const bool listed = many == record.many_echoes.end();
      if (!listed) row.paths = static_cast<int>(std::min<std::size_t>(many->pairs, 1'000'000'000));
      row.echo_time = strongest->received.delay;
      row.echo_level_db = strongest->level_db;
      row.reverberation_db = parts.reverberation_db(
          row.array,
          strongest->received.delay + 0.5 * pulse.duration() / strongest->received.doppler);
      row.echo_peak_db = source_level_db +
                         db_from_amplitude(listed ? parts.peak(row.array, received) : many->peak);
      row.signal_excess_db = row.echo_peak_db - db_from_power(power_from_db(row.reverberation_db) +
                                                              power_from_db(row.noise_db));
    }
    summary.push_back(row);
  }
  return summary;
}

std::string echo_beside_record(const PingRecord& record, const Scenario& scenario,
                               const Pulse& pulse) {
  if (scenario.pings.continuous) return "";
  const double begin = scenario.pings.recording_start, end = end_of_record(scenario);
  for (const TargetSummary& target : record.summary) {
    if (target.paths == 0) continue;
    const double last = target.echo_time + pulse.duration();
    if (target.echo_time >= begin && last <= end) continue;
    char text[256];
    std::snprintf(
        text, sizeof text,
        "pings.recording_duration: the loudest echo of target %s is received from %.5g to "
        "%.5g s after ping %d, whose record holds %g to %g s",
        target.name.c_str(), target.echo_time, last, record.ping, begin, end);
    return text;
  }
  return "";
}

}  // namespace asdic::detail
