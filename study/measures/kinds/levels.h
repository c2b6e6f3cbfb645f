#pragma once
#include "study/measures/measure.h"

// The levels of the ping's own summary.
namespace asdic::detail::study {

struct EchoLevel {
  static constexpr std::string_view
      name = "echo_level",
      column = "echo_level_db", unit = level_unit,
      meaning = "all paths together, the peak of their envelope/√2; −∞: none";
  static double of(const TargetSummary& t) { return t.echo_peak_db; }
};

struct ReverberationLevel {
  static constexpr std::string_view name = "reverberation_level", column = "reverberation_level_db",
                                    unit = level_unit,
                                    meaning =
                                        "expected at the time of the strongest path; −∞: none";
  static double of(const TargetSummary& t) { return t.reverberation_db; }
};

struct NoiseLevel {
  static constexpr std::string_view name = "noise_level", column = "noise_level_db",
                                    unit = level_unit, meaning = "of the noise in the pulse's band";
  static double of(const TargetSummary& t) { return t.noise_db; }
};

struct EchoToBackground {
  static constexpr std::string_view
      name = "echo_to_background",
      column = "echo_to_background_db", unit = "dB",
      meaning = "echo over reverberation and noise in the band, before any processing; −∞: no path";
  static double of(const TargetSummary& t) { return t.signal_excess_db; }
};

struct SignalExcess {
  static constexpr std::string_view name = "signal_excess", column = "signal_excess_db",
                                    unit = "dB",
                                    meaning = "old name of echo_to_background_db; will go";
  static double of(const TargetSummary& t) { return t.signal_excess_db; }
};

struct Paths {
  static constexpr std::string_view name = "paths", column = "paths", unit = "1",
                                    meaning = "pairs of paths there and back";
  static double of(const TargetSummary& t) { return static_cast<double>(t.paths); }
};

struct EchoTime {
  static constexpr std::string_view name = "echo_time", column = "echo_time", unit = "s",
                                    meaning = "delay of the strongest pair of paths";
  static double of(const TargetSummary& t) { return t.echo_time; }
};

}  // namespace asdic::detail::study
