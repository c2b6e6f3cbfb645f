#pragma once

/// \file
/// The channel from a transmitter to the phones of an array: its time-varying impulse response, and
/// what the phones receive of any signal through it. docs/theory/channel.md
///
/// ```cpp
/// asdic::Scenario scenario = asdic::Scenario::read("modem.toml");
/// const asdic::Channel channel = asdic::channel(scenario, {.duration = 0.5});
/// for (const asdic::ChannelPath& path : channel.phones.front())
///   std::cout << path.delay.front() << " s, Doppler factor " << path.doppler.front() << '\n';
/// const std::vector<double> click{1.0, -1.0};  // [Pa] at 1 m, 48 000 times a second
/// const asdic::ChannelOutput heard = asdic::through(scenario, channel, click, 48e3);
/// std::cout << heard.samples << " samples from " << heard.start << " s on\n";
/// ```

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"
#include "asdic/watch.h"

namespace asdic {

/// Which channel, and for how long.
struct ChannelOptions {
  int ping = 1;   ///< of all transmitters, from 1: who sends, and from when on
  int array = 0;  ///< in the scenario, from 0
  std::optional<double> duration = {};   ///< of what is sent [s]; the pulse's
  double step = 0.1;                     ///< between times at most [s]; finer where things turn
  std::optional<double> frequency = {};  ///< of the amplitudes [Hz]; the pulse's centre
  /// Each path keeps the amplitude that it begins with, as in a ping, whose pressure the signal's
  /// then is; else amplitudes change as things move.
  bool held = false;
};

/// One path over the time at which sound is sent; NaN where there is no such path. [times] each
struct ChannelPath {
  int surface_bounces = 0, bottom_bounces = 0;
  int upper_turns = 0, lower_turns = 0;           ///< turning points in the water
  std::vector<double> delay{};                    ///< from leaving to being received [s]
  std::vector<std::complex<double>> amplitude{};  ///< re 1 m, the transmitter's pattern in it
  std::vector<double> doppler{};                  ///< received over sent frequency
  std::vector<double> launch_elevation{}, arrival_elevation{};  ///< of travel, positive up [rad]
  std::vector<double> arrival_bearing{};                        ///< of travel, true [rad]
  std::vector<double> length{};                                 ///< along the path [m]
};

/// Direct sound and its mirrored and refracted paths; no target, no scatterer.
struct Channel {
  double frequency = 0.0;                          ///< of the amplitudes [Hz]
  double sent = 0.0;                               ///< time 0, of the scenario's clock [s]
  std::vector<double> times{};                     ///< at which sound leaves, from 0 [s]
  std::vector<std::vector<ChannelPath>> phones{};  ///< [phones of the array][paths]
  std::vector<std::string> warnings{};             ///< what to know before trusting it
};

/// Exact paths at every time and phone. Between its times, sound was sent by cubics of the time at
/// which it is received, whose phase is right to 0.001 rad.
/// \throws InputError naming the argument ("channel.array"), Stopped
[[nodiscard]] ASDIC_API Channel channel(const Scenario& scenario,
                                        const ChannelOptions& options = {},
                                        const Watch& watch = {});

/// What the phones receive of a signal.
struct ChannelOutput {
  double start = 0.0;                   ///< of the first sample, after the channel's time 0 [s]
  double sample_rate = 0.0;             ///< [Hz]
  std::size_t samples = 0;              ///< of each phone
  std::vector<float> pressure{};        ///< [phones × samples] [Pa]
  std::vector<std::string> warnings{};  ///< the channel's, and those of this signal
};

/// p(t) = Σ Re{A(u)·s₊(u)} over the paths: u is when what is received at t was sent, s₊ the
/// analytic signal. Amplitudes are those of the channel's frequency at all of the signal's: a
/// warning tells where absorption alone differs by more than 1 dB within its band.
/// \param signal  pressure at 1 m, from the channel's time 0 on [Pa]   \param sample_rate  [Hz]
/// \throws InputError for a signal longer than the channel
[[nodiscard]] ASDIC_API ChannelOutput through(const Scenario& scenario, const Channel& channel,
                                              std::span<const double> signal, double sample_rate,
                                              const Watch& watch = {});

}  // namespace asdic
