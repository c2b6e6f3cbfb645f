#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// A pulse as sampled in a file: its real pressure, scaled so that the peak envelope is 1.
struct SampledPulse {
  static constexpr std::string_view name = "file", title = "from a file";
  std::vector<double> samples = {};  ///< real pressure
  double sample_rate = 0.0;          ///< [Hz]
  std::string file = {};             ///< where the samples came from, for the record

  void describe(Fields& field);
  [[nodiscard]] bool operator==(const SampledPulse&) const = default;
};
static_assert(SampledWaveform<SampledPulse>);

}  // namespace asdic::detail
