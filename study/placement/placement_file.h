#pragma once
#include <string>
#include <vector>

#include "io/files/output_file.h"
#include "study/placement/placement_run.h"

namespace asdic::detail::study {

/// Writes the file of docs/formats/placement.md. \throws RunError
void write_placement(OutputFile&& to, const PlacementPlan& plan, const Placement& found);

/// The answer, for people and programs: what is in the file's attributes and small datasets.
struct PlacementAnswer {
  struct Sensor {
    double east = 0.0, north = 0.0;  ///< [m]
    std::string option;
    double without = 0.0;  ///< share that is detected without it
  };
  std::string title;
  std::size_t sensors = 1, at_least = 1, places = 0, candidates = 0, draws = 1, judging = 0;
  bool multistatic = false, proved = false, told_apart = false;
  double sets = 0.0, value = 0.0, upper_bound = 1.0, greedy = 0.0, swapped = 0.0;
  int swaps = 0;
  double share = 0.0, deviation = 0.0;  ///< of the draws that judge
  double confidence = 0.95, difference = 0.0, low = 0.0, high = 0.0;
  std::size_t better = 0, worse = 0;
  double least = 0.0, below_half = 0.0, silent = 0.0;
  std::vector<Sensor> best, runner_up;
  std::vector<std::string> warnings;
};
[[nodiscard]] PlacementAnswer answer_of(const PlacementPlan& plan, const Placement& found);
/// \throws InputError if it is no such file, or a part is missing
[[nodiscard]] PlacementAnswer read_placement_answer(const std::filesystem::path& path);

}  // namespace asdic::detail::study
