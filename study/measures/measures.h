#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "sonar/ping/ping.h"
#include "study/measures/realisation.h"
#include "study/plan/study.h"

namespace asdic::study {

/// A measure of a target's levels: needs no samples.
struct LevelMeasure {
  std::string_view key;  ///< in [measure]
  std::string_view column, unit, meaning;
  double (*of)(const TargetSummary& target);
};
[[nodiscard]] std::span<const LevelMeasure> level_measures();

/// The columns of a study's measures. \param scenario  of any realisation: its targets
[[nodiscard]] std::vector<Column> measure_columns(const Study& study, const Scenario& scenario);

/// What one realisation's ping measures.
struct Measured {
  std::vector<double> values;  ///< [measure columns]
  PingRecord record;           ///< with samples, where the plan needs any
};
/// \param simulator  of the realisation's scenario   \throws InputError
[[nodiscard]] Measured measure(const Study& study, const PingSimulator& simulator);

}  // namespace asdic::study
