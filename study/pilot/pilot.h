#pragma once
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "study/measures/realisation.h"
#include "study/pilot/candidates.h"
#include "study/pilot/prediction.h"
#include "study/summary/summary_parts.h"

// What a study will cost, by a few of its rows: docs/theory/studies.md
namespace asdic::detail::study {

struct PilotOptions {
  std::uint64_t rows = 16;       ///< that are tried, at least; of blocks whole ones, of four
  std::uint64_t changed = 4;     ///< of them with what may be turned
  std::vector<std::string> set;  ///< overrides of the command line
  double confidence = 0.95;      ///< of the prediction
  std::stop_token stop{};
  std::function<void(std::uint64_t done, std::uint64_t of)> progress{};
};

struct PilotRow {
  std::uint64_t index = 0;
  RowCost cost{};
  double memory = 0.0;  ///< at its peak, beyond what the process held before [bytes]; NaN: not told
  bool valid = true;
};

/// How much a row's cost goes with an input.
struct CostDriver {
  std::string input;
  RankCorrelation rank{};
};

/// What rows would cost with something turned.
struct Turned {
  Candidate candidate;
  double share = 1.0;  ///< of what the same rows cost as they are
};

struct Pilot {
  std::uint64_t count = 0;            ///< rows of the whole study
  std::uint64_t group = 1;            ///< rows that are tried together
  std::vector<PilotRow> rows{};       ///< in the order of their indices
  RowCost mean{};                     ///< of these rows
  double start = 0.0;                 ///< what the first row took beyond others, once [s]
  Predicted processor{};              ///< of all rows, on whatever number of threads [s]
  double again = 1.0;                 ///< cost of rows that are made again, of what they cost first
  std::vector<CostDriver> drivers{};  ///< those that are told from none, the strongest first
  std::size_t ordered = 0;            ///< inputs whose values have an order
  std::vector<Turned> turned{};       ///< the cheapest first
  std::vector<Candidate> refused{};   ///< that do not go with what else is set
  double row_memory = 0.0;            ///< the most of a row that was tried; NaN: not told [bytes]
  Predicted row_most{};               ///< of the dearest row of the study [bytes]
  double base_memory = 0.0;           ///< beside the rows [bytes]
  double budget = 0.0;                ///< of all rows at a time (run.memory) [bytes]
  double file_row = 0.0;              ///< bytes of the result for a row, beside kept samples' own
  double kept_row = 0.0;  ///< of samples, spectra, detections that are kept, on the average …
  bool kept_met = true;   ///< … but for those of which no row that was tried keeps any
};

/// Makes some rows, one at a time, each by itself; nothing is written.
/// \param study  as the overrides make it
/// \throws InputError of a row that makes no scenario (on_error = "stop"); Interrupted
[[nodiscard]] Pilot pilot(const Study& study, const PilotOptions& options);

}  // namespace asdic::detail::study
