#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sonar/ping/ping_record.h"
#include "sonar/reverberation/ping_reverberation.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/pulse.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// Mean-square pressure over all phones in steps of time, for each part of the sound: echoes as
/// received, expected reverberation and noise.
class LevelMeter {
 public:
  /// \param pulse_duration  the steps' length, at most 50 ms, but at least a 20 000th of the record
  /// and two samples
  LevelMeter(const Recording& recording, double pulse_duration);

  /// \param peak_pressure  of the source at 1 m [Pa], the unit of the baseband
  void add_echo(const Baseband& received, double peak_pressure);
  /// \param share  share of all phones that belong to the receiving array
  void add_reverberation(const PingReverberation& sea, double peak_pressure, double share,
                         PropagationMemory& memory);
  void add_noise(double variance);  ///< of every sample [Pa²]

  [[nodiscard]] LevelSeries series() const { return series_; }

 private:
  double start_;  // beginning of the record [s]
  LevelSeries series_;
};

/// Functions that summarise() calls for each target.
struct SummaryParts {
  /// Largest envelope of echoes as they add at an array, over the pulse's peak at 1 m.
  std::function<double(int array, std::span<const EchoPath> echoes)> peak;
  /// Expected level at an array at a time [dB re 1 µPa].
  std::function<double(int array, double time)> reverberation_db;
};

/// Summary of a ping's echoes, one per target: the strongest pair of paths at the array that
/// receives it, with reverberation and noise at its time.
[[nodiscard]] std::vector<TargetSummary> summarise(const PingRecord& record,
                                                   const Scenario& scenario, const Pulse& pulse,
                                                   const SummaryParts& parts);

/// Warning of a target whose loudest echo the ping's record does not hold completely; empty: none.
/// \param pulse  the pulse that was sent
[[nodiscard]] std::string echo_beside_record(const PingRecord& record, const Scenario& scenario,
                                             const Pulse& pulse);

}  // namespace asdic::detail
