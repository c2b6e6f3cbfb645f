#include "watched.h"

namespace asdic::python {
namespace {

using namespace py::literals;

/// [phones, paths, times], NaN where a phone has fewer paths.
template <class T>
py::array cube(const Channel& channel, std::vector<T> ChannelPath::*member, T nothing) {
  std::size_t paths = 0;
  for (const auto& phone : channel.phones) paths = std::max(paths, phone.size());
  const std::size_t times = channel.times.size();
  std::vector<T> values(channel.phones.size() * paths * times, nothing);
  for (std::size_t n = 0; n < channel.phones.size(); ++n)
    for (std::size_t p = 0; p < channel.phones[n].size(); ++p)
      std::copy_n((channel.phones[n][p].*member).begin(), times,
                  values.begin() + static_cast<std::ptrdiff_t>((n * paths + p) * times));
  return taken(std::move(values),
               {static_cast<py::ssize_t>(channel.phones.size()), static_cast<py::ssize_t>(paths),
                static_cast<py::ssize_t>(times)});
}

/// [phones, paths], −1 where a phone has fewer paths.
py::array counts(const Channel& channel, int ChannelPath::*member) {
  std::size_t paths = 0;
  for (const auto& phone : channel.phones) paths = std::max(paths, phone.size());
  std::vector<std::int32_t> values(channel.phones.size() * paths, -1);
  for (std::size_t n = 0; n < channel.phones.size(); ++n)
    for (std::size_t p = 0; p < channel.phones[n].size(); ++p)
      values[n * paths + p] = channel.phones[n][p].*member;
  return taken(std::move(values),
               {static_cast<py::ssize_t>(channel.phones.size()), static_cast<py::ssize_t>(paths)});
}

py::dict shown(const Channel& channel) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto number = [&](std::vector<double> ChannelPath::*member) {
    return cube(channel, member, none);
  };
  const auto angle = [&](std::vector<double> ChannelPath::*member) {
    return number(member).attr("__mul__")(degrees(1.0));
  };
  return py::dict(
      "time"_a = py::cast(channel.times), "frequency"_a = channel.frequency,
      "sent"_a = channel.sent, "delay"_a = number(&ChannelPath::delay),
      "amplitude"_a = cube(channel, &ChannelPath::amplitude, std::complex<double>(none, none)),
      "doppler_factor"_a = number(&ChannelPath::doppler),
      "path_length"_a = number(&ChannelPath::length),
      "launch_elevation_deg"_a = angle(&ChannelPath::launch_elevation),
      "arrival_elevation_deg"_a = angle(&ChannelPath::arrival_elevation),
      "arrival_bearing_deg"_a = angle(&ChannelPath::arrival_bearing),
      "surface_bounces"_a = counts(channel, &ChannelPath::surface_bounces),
      "bottom_bounces"_a = counts(channel, &ChannelPath::bottom_bounces),
      "upper_turns"_a = counts(channel, &ChannelPath::upper_turns),
      "lower_turns"_a = counts(channel, &ChannelPath::lower_turns),
      "warnings"_a = channel.warnings);
}

}  // namespace

void add_channel(py::module_& module) {
  py::class_<Channel>(module, "Channel").def_property_readonly("shown", &shown);
  module.def(
      "channel", [](const Scenario& scenario, int ping, int array, std::optional<double> duration,
                    double step, std::optional<double> frequency, bool held) {
        const ChannelOptions options{.ping = ping,
                                     .array = array,
                                     .duration = duration,
                                     .step = step,
                                     .frequency = frequency,
                                     .held = held};
        return watched([&](const Watch& watch) { return channel(scenario, options, watch); });
      });
  using Signal = py::array_t<double, py::array::c_style | py::array::forcecast>;
  module.def("through", [](const Scenario& scenario, const Channel& channel, const Signal& signal,
                           double sample_rate) {
    const std::span<const double> samples(signal.data(), static_cast<std::size_t>(signal.size()));
    ChannelOutput out = watched([&](const Watch& watch) {
      return through(scenario, channel, samples, sample_rate, watch);
    });
    const auto phones = static_cast<py::ssize_t>(channel.phones.size());
    return py::make_tuple(
        taken(std::move(out.pressure), {phones, static_cast<py::ssize_t>(out.samples)}), out.start,
        out.warnings);
  });
}

}  // namespace asdic::python
