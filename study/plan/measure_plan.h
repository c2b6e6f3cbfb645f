#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/toml_value.h"
#include "processing/ping_processor.h"

namespace asdic::detail {
class PingSimulator;
struct PingRecord;
}  // namespace asdic::detail

namespace asdic::detail::study {

/// A matched filter where and when the target's echo is known to come: its answer there, and where
/// there is no echo. docs/theory/studies.md
struct MatchedFilterPlan {
  /// What the answer is compared with.
  enum class Background {
    around,    ///< the mean of free cells before and after it (cell averaging)
    trend,     ///< the same cells, of which the level may rise or fall evenly in dB
    expected,  ///< the mean over draws of noise and scatterers at the very time, without targets
    summed,    ///< the same mean, summed over what is drawn from
    noise      ///< the ambient noise as the scenario gives it: white and independent, nothing else
  };
  Background background = Background::around;
  std::optional<int> phone;  ///< of the array alone, from 0; none: a beam to where the echo is from
  double guard_cells = 2.0, reference_cells = 12.0;  ///< on either side, of 1/noise bandwidth
  int draws = 24;                                    ///< of the expected background

  /// Values that the background is estimated from: ∞ where it is known.
  [[nodiscard]] double estimated_from() const noexcept {
    if (background == Background::noise || background == Background::summed)
      return std::numeric_limits<double>::infinity();
    return background == Background::expected ? draws : 2.0 * reference_cells;
  }
};

/// All cells of the record without an echo, counted by time after the ping.
struct CellPlan {
  std::vector<double> edges;  ///< of the bins of time [s]
};

/// Detection in several pings of a realisation, one after the other.
struct PingRunPlan {
  int first = 1;             ///< of the scenario's pings, counted from 1
  int count = 2;             ///< of them
  int hits = 0, within = 0;  ///< a track begins after so many hits within so many pings in a row;
                             ///< 0: nobody asks
  std::optional<TrackerSettings> tracker{};  ///< of the receiver's detections, if it is asked
  [[nodiscard]] bool initiates() const noexcept { return within > 0; }
};

/// Detection of each target.
struct DetectionPlan {
  enum class By {
    matched_filter,  ///< its answer at the echo's time over a threshold
    receiver         ///< a detection of the whole receiver that is the target's (asdic process)
  };
  By by = By::matched_filter;
  double false_alarm_probability = 1e-4;  ///< of a cell
};

/// What measures take beside the levels of a ping.
struct Needs {
  bool targets = false;         ///< a scenario with targets
  bool samples = false;         ///< all that the array records
  bool matched_filter = false;  ///< [measure.matched_filter], and the samples that it looks at
  bool receiver = false;        ///< [measure.receiver], and all samples
};

/// A measure that no file can say: a function of a program that uses the library.
struct OwnMeasure {
  std::string name;     ///< of its column, in [a-z0-9_]
  std::string unit;     ///< "dB", "1"
  std::string meaning;  ///< of the column
  std::string version;  ///< rows of another one are not this study's
  bool samples = true;  ///< it takes what the phones receive, and not levels alone
  /// From any thread. \param scenario  of the realisation, with what was drawn in it
  std::function<double(const TomlValue& scenario, const PingSimulator& simulator,
                       const PingRecord& record)>
      of{};
};

/// How the spectra that are kept are made of what the array receives.
struct SpectrumPlan {
  std::optional<double> resolution;  ///< step of the frequencies at most [Hz]; none: the record's
  bool each_phone = false;           ///< a spectrum for each; else the mean of their powers

  bool operator==(const SpectrumPlan&) const = default;
};

/// Whether something that is kept of every k-th index is kept of this one. \param every  k; 0: none
[[nodiscard]] constexpr bool keeps(std::uint64_t every, std::uint64_t index) noexcept {
  return every > 0 && index % every == 0;
}

/// What is measured in every realisation.
struct MeasurePlan {
  int ping = 1;                      ///< of the scenario, counted from 1
  int array = 0;                     ///< an index
  std::vector<std::string> wanted;   ///< the measures whose keys are true
  Needs needs;                       ///< of any of these
  MatchedFilterPlan matched_filter;  ///< how the matched filter's answers are had
  std::optional<DetectionPlan> detection;
  std::optional<PingRunPlan> run;  ///< of pings, each with a detection
  std::optional<CellPlan> cells;   ///< of the matched filter
  ProcessingSettings receiver;     ///< of detection by = "receiver", localisation, detections
  std::vector<OwnMeasure> own;     ///< after all others
  std::uint64_t series_every = 0;  ///< the time series of every k-th index; 0: none
  std::uint64_t spectra_every = 0;
  SpectrumPlan spectrum;
  std::uint64_t detections_every = 0;  ///< what the receiver detects

  [[nodiscard]] bool wants(std::string_view measure) const {
    return std::find(wanted.begin(), wanted.end(), measure) != wanted.end();
  }
  /// Whether there is anything that needs samples, and not levels alone.
  [[nodiscard]] bool needs_samples() const noexcept {
    return needs.samples || uses_matched_filter() || uses_receiver() || keeps_any() ||
           own_takes_samples();
  }
  [[nodiscard]] bool own_takes_samples() const noexcept {
    return std::any_of(own.begin(), own.end(), [](const OwnMeasure& one) { return one.samples; });
  }
  /// Whether some rows keep more than their columns.
  [[nodiscard]] bool keeps_any() const noexcept {
    return series_every > 0 || spectra_every > 0 || detections_every > 0;
  }
  /// Of a cell, that thresholds are for.
  [[nodiscard]] double false_alarm_probability() const noexcept {
    return detection ? detection->false_alarm_probability : DetectionPlan().false_alarm_probability;
  }
  /// In every row: has columns of its answers.
  [[nodiscard]] bool uses_receiver() const noexcept {
    return needs.receiver || (detection && detection->by == DetectionPlan::By::receiver);
  }
  [[nodiscard]] bool uses_matched_filter() const noexcept {
    return needs.matched_filter ||
           (detection && detection->by == DetectionPlan::By::matched_filter);
  }
  /// Whether of the samples only those count that a matched filter looks at.
  [[nodiscard]] bool filter_alone() const noexcept {
    return uses_matched_filter() && !cells && !uses_receiver() && !needs.samples && !keeps_any() &&
           !own_takes_samples();
  }
};

}  // namespace asdic::detail::study
