#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sonar/ping/ping.h"

namespace asdic::detail {

/// One path from a transmitter to a phone over the time at which sound is sent: NaN where there is
/// no such path. [times] each
struct ChannelPath {
  int surface_bounces = 0, bottom_bounces = 0, upper_turns = 0, lower_turns = 0;
  std::vector<double> delay;                    ///< from leaving to being received [s]
  std::vector<std::complex<double>> amplitude;  ///< re 1 m, the transmitter's pattern in it
  std::vector<double> doppler;                  ///< received over sent frequency
  std::vector<double> launch_elevation, arrival_elevation;  ///< of travel, positive up [rad]
  std::vector<double> arrival_bearing;                      ///< of travel, true [rad]
  std::vector<double> length;                               ///< along the path [m]
};

/// What a transmitter's sound goes through on its way to each phone of an array, no target and no
/// scatterer: its time-varying impulse response. Docs: docs/theory/channel.md
struct Channel {
  double frequency = 0.0;     ///< of the amplitudes [Hz]
  double sent = 0.0;          ///< time 0, since the start of the scenario [s]
  std::vector<double> times;  ///< at which sound leaves, from 0; denser where things turn [s]
  std::vector<std::vector<ChannelPath>> phones;  ///< [channels][paths]
  std::vector<std::string> warnings;             ///< what to know before trusting it
};

/// How a channel is asked for.
struct ChannelNeed {
  int ping = 1;            ///< of all transmitters, from 1: who sends, and when time 0 is
  int array = 0;           ///< that receives
  double duration = 1.0;   ///< of what is sent [s]
  double step = 0.1;       ///< between times at most [s]
  double frequency = 0.0;  ///< [Hz]; 0: the pulse's centre
  bool held = false;       ///< each path keeps its first amplitude, as in a ping
};

/// Exact paths at every time and phone; between times, cubics whose phase is right to
/// `negligible_phase` (sonar/paths/delay_curve.h) at `frequency`.
[[nodiscard]] Channel channel(const PingSimulator& simulator, const ChannelNeed& need);

/// What the phones receive of a signal.
struct ChannelOutput {
  double start = 0.0;           ///< of the first sample, after time 0 [s]
  std::size_t samples = 0;      ///< of each phone
  std::vector<float> pressure;  ///< [channels × samples] [Pa]
};

/// p_n(t) = Σ Re{A(u)·s₊(u)}, u when what is received at t was sent, s₊ the analytic signal.
/// \param signal  from time 0 on, pressure at 1 m [Pa]   \param rate  [Hz]
/// \throws InputError for a signal longer than the channel
[[nodiscard]] ChannelOutput through(const Channel& channel, std::span<const double> signal,
                                    double rate);

/// The band of a signal: between the frequencies below and above which lies half a percent of its
/// energy each [Hz].
struct SignalBand {
  double low = 0.0, high = 0.0;
};
[[nodiscard]] SignalBand band_of(std::span<const double> signal, double rate);

/// By how much absorption along the channel's longest path that is not 40 dB below the loudest
/// changes within a band against its frequency [dB].
[[nodiscard]] double absorption_error_db(const Channel& channel, const Environment& ocean,
                                         const SignalBand& band);

}  // namespace asdic::detail
