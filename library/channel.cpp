#include "asdic/channel.h"

#include "core/quantity.h"
#include "core/text.h"
#include "library/arguments.h"
#include "library/physics.h"
#include "library/watched.h"
#include "sonar/channel/channel.h"

namespace asdic {
namespace {

constexpr double told_from = 1.0;  // [dB]

ChannelPath shown(detail::ChannelPath&& path) {
  return {.surface_bounces = path.surface_bounces,
          .bottom_bounces = path.bottom_bounces,
          .upper_turns = path.upper_turns,
          .lower_turns = path.lower_turns,
          .delay = std::move(path.delay),
          .amplitude = std::move(path.amplitude),
          .doppler = std::move(path.doppler),
          .launch_elevation = std::move(path.launch_elevation),
          .arrival_elevation = std::move(path.arrival_elevation),
          .arrival_bearing = std::move(path.arrival_bearing),
          .length = std::move(path.length)};
}

/// What a signal goes through. \throws InputError for lists that do not go together
detail::Channel inner(const Channel& channel) {
  detail::Channel made{
      .frequency = channel.frequency, .sent = channel.sent, .times = channel.times};
  if (made.times.size() < 2) throw InputError("channel.times", "none", "two or more");
  for (const auto& phone : channel.phones) {
    auto& to = made.phones.emplace_back();
    for (const ChannelPath& path : phone) {
      for (const std::size_t size : {path.delay.size(), path.amplitude.size(), path.doppler.size()})
        if (size != made.times.size())
          throw InputError("channel.phones", detail::count_of(size, "number") + " of a path",
                           "one for each of " + detail::count_of(made.times.size(), "time"));
      to.push_back({.surface_bounces = path.surface_bounces,
                    .bottom_bounces = path.bottom_bounces,
                    .upper_turns = path.upper_turns,
                    .lower_turns = path.lower_turns,
                    .delay = path.delay,
                    .amplitude = path.amplitude,
                    .doppler = path.doppler,
                    .length = path.length});
    }
  }
  return made;
}

}  // namespace

Channel channel(const Scenario& scenario, const ChannelOptions& options, const Watch& watch) {
  return watched(watch, [&] {
    const detail::PingSimulator& simulator = Access::physics(scenario).simulator();
    require("channel.ping", options.ping, 1, simulator.pings());
    require("channel.array", options.array, 0,
            static_cast<int>(simulator.scenario().arrays.size()) - 1);
    const detail::Quantity time{
        .noun = "time", .unit = "s", .low = 0.0, .high = 1e6, .above = true};
    require("channel.duration", options.duration, time);
    require("channel.step", options.step, time);
    require("channel.frequency", options.frequency,
            {.noun = "frequency", .unit = "Hz", .low = 0.0, .high = 1e7, .above = true});
    const int transmitter = simulator.transmission(options.ping).transmitter;
    detail::Channel found = detail::channel(
        simulator, {.ping = options.ping,
                    .array = options.array,
                    .duration = options.duration.value_or(simulator.pulse(transmitter).duration()),
                    .step = options.step,
                    .frequency = options.frequency.value_or(0.0),
                    .held = options.held});
    Channel result{.frequency = found.frequency,
                   .sent = found.sent,
                   .times = std::move(found.times),
                   .warnings = std::move(found.warnings)};
    for (auto& phone : found.phones) {
      auto& to = result.phones.emplace_back();
      for (detail::ChannelPath& path : phone) to.push_back(shown(std::move(path)));
    }
    return result;
  });
}

ChannelOutput through(const Scenario& scenario, const Channel& channel,
                      std::span<const double> signal, double sample_rate, const Watch& watch) {
  return watched(watch, [&] {
    require("sample_rate", sample_rate,
            {.noun = "sample rate", .unit = "Hz", .low = 0.0, .high = 1e8, .above = true});
    if (signal.empty()) throw InputError("signal", "no sample", "one or more");
    const detail::Channel within = inner(channel);
    detail::ChannelOutput found = detail::through(within, signal, sample_rate);
    ChannelOutput result{.start = found.start,
                         .sample_rate = sample_rate,
                         .samples = found.samples,
                         .pressure = std::move(found.pressure),
                         .warnings = channel.warnings};
    const detail::SignalBand band = detail::band_of(signal, sample_rate);
    const double off = detail::absorption_error_db(
        within, Access::physics(scenario).simulator().scenario().environment, band);
    if (off > told_from)
      result.warnings.push_back(
          "channel: within the signal's band, " + detail::to_text(std::round(band.low)) + " to " +
          detail::to_text(std::round(band.high)) + " Hz, absorption differs by up to " +
          detail::to_text(std::round(10.0 * off) / 10.0) + " dB from that of " +
          detail::to_text(channel.frequency) + " Hz, which the channel takes for all of it");
    return result;
  });
}

}  // namespace asdic
