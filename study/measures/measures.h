#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sonar/ping/ping.h"
#include "study/measures/kinds/detection_signal_excess.h"
#include "study/measures/kinds/levels.h"
#include "study/measures/kinds/matched_filter.h"
#include "study/measures/kinds/of_the_receiver.h"
#include "study/measures/kinds/over_pings.h"
#include "study/measures/kinds/series_level.h"
#include "study/measures/kinds/strongest_path.h"
#include "study/measures/kinds/target_place.h"
#include "study/measures/measure.h"
#include "study/plan/study.h"

namespace asdic::detail::study {

template <Measure... M>
inline constexpr std::array<AnyMeasure, sizeof...(M)> measure_list{any_measure<M>()...};

/// Every measure, in the order of the columns. A new one is one file and one name here.
inline constexpr std::span<const AnyMeasure> all_measures =
    measure_list<EchoLevel, ReverberationLevel, NoiseLevel, EchoToBackground, SignalExcess, Paths,
                 EchoTime, DetectionSignalExcess, StrongestPath, TargetPlace, OverPings,
                 MatchedFilterAnswer, DetectionByReceiver, LocalisationError, LocalisationEllipse,
                 FalseAlarms, SeriesLevel>;

/// The columns of a study's measures. \param scenario  of any realisation: its targets
[[nodiscard]] std::vector<Column> measure_columns(
    const Study& study, const Scenario& scenario,
    std::span<const AnyMeasure> measures = all_measures);

/// What one realisation's ping measures.
struct Measured {
  std::vector<double> values;         ///< [measure columns]
  PingRecord record;                  ///< with samples, where the plan needs any
  std::vector<std::uint8_t> cells{};  ///< packed_counts(), where cells are counted
  ReceiverAnswers receiver{};         ///< where it is used, or asked for
  std::string unknown{};              ///< reason why a value is not known; "": none was given
};
/// \param simulator  of the realisation's scenario   \param shared  what draws of its background
/// have in common with others   \param cost  gets what each stage took, where somebody asks
/// \param detections  whether what the receiver detects is asked for, which it then is once
/// \throws InputError
[[nodiscard]] Measured measure(const Study& study, const PingSimulator& simulator,
                               std::span<const AnyMeasure> measures = all_measures,
                               const std::shared_ptr<SharedPropagation>& shared = nullptr,
                               RowCost* cost = nullptr, bool detections = false);

}  // namespace asdic::detail::study
