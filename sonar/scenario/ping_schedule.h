#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace asdic::detail {

class Fields;

/// What the phones' samples are.
enum class Samples {
  pressure,  ///< real, at the sample rate
  baseband   ///< complex, p₊·e^{−i2πf_c t}: tens of times smaller for a narrow band
};
inline constexpr std::string_view samples_words[] = {"pressure", "baseband"};
constexpr std::span<const std::string_view> words(Samples /*any*/) { return samples_words; }

/// When pings are sent and how they are recorded. A transmitter may have times of its own.
struct PingSchedule {
  int count = 1;                     ///< of each transmitter
  double interval = 60.0;            ///< from ping to ping of one transmitter [s]
  std::vector<double> elevations;    ///< transmitter elevation of each ping [rad], repeated as
                                     ///< needed; empty: the transmitter's own
  double recording_duration = 60.0;  ///< a ping is received that long after its start [s]
  double recording_start = 0.0;      ///< [s]
  double sample_rate = 16000.0;      ///< of pressure [Hz]

  /// One stream per phone without gaps: the record of a ping ends where the next one (of any
  /// transmitter) begins, and holds what is still received of those before. Pings are then sent at
  /// whole samples.
  bool continuous = false;
  /// Arrays on the transmitter's platform receive nothing while it transmits.
  bool blanking = false;

  Samples samples = Samples::pressure;
  std::optional<double> carrier;        ///< of the baseband [Hz]; none: the middle of the pulses
  std::optional<double> baseband_rate;  ///< [Hz]; none: the pulses' band with its Doppler shifts

  void describe(Fields& field);
};

}  // namespace asdic::detail
