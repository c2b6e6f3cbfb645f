#pragma once
#include <vector>

namespace asdic {

/// When pings are sent and how they are recorded. A transmitter may have times of its own.
struct PingSchedule {
  int count = 1;                     ///< of each transmitter
  double interval = 60.0;            ///< from ping to ping of one transmitter [s]
  std::vector<double> elevations;    ///< transmitter elevation of each ping [rad], repeated as
                                     ///< needed; empty: the transmitter's own
  double recording_duration = 60.0;  ///< after the start of each ping [s]
  double recording_start = 0.0;      ///< [s]
  double sample_rate = 16000.0;      ///< [Hz]
};

}  // namespace asdic
