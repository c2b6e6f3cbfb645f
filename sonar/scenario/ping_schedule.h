#pragma once
#include <optional>
#include <vector>

namespace asdic {

/// What the phones' samples are.
enum class Samples {
  pressure,  ///< real, at the sample rate
  baseband   ///< complex, p₊·e^{−i2πf_c t}: tens of times smaller for a narrow band
};

/// When pings are sent and how they are recorded. A transmitter may have times of its own.
struct PingSchedule {
  int count = 1;                     ///< of each transmitter
  double interval = 60.0;            ///< from ping to ping of one transmitter [s]
  std::vector<double> elevations;    ///< transmitter elevation of each ping [rad], repeated as
                                     ///< needed; empty: the transmitter's own
  double recording_duration = 60.0;  ///< a ping is heard that long after its start [s]
  double recording_start = 0.0;      ///< [s]
  double sample_rate = 16000.0;      ///< of pressure [Hz]

  /// One stream per phone without gaps: the record of a ping ends where the next one (of any
  /// transmitter) begins, and holds what is still heard of those before. Pings are then sent at
  /// whole samples.
  bool continuous = false;
  /// Arrays on the transmitter's platform hear nothing while it transmits.
  bool blanking = false;

  Samples samples = Samples::pressure;
  std::optional<double> carrier;        ///< of the baseband [Hz]; none: the middle of the pulses
  std::optional<double> baseband_rate;  ///< [Hz]; none: the pulses' band with its Doppler shifts
};

}  // namespace asdic
