#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "raytrace/parallel/progress.h"

// Where sensors are best put, once it is known what each of them would see.
// docs/theory/placement.md
namespace asdic::detail {

/// A sensor that may be chosen: somewhere, working in one of several ways.
struct PlacementCandidate {
  std::size_t place = 0, option = 0;
};

/// What candidates see of cells that matter, in each of several draws of what nobody knows.
struct PlacementProblem {
  std::vector<PlacementCandidate> candidates;  ///< sorted by place
  bool pairs = false;          ///< each sensor hears the pings of all that are chosen
  std::size_t sensors = 1;     ///< to be chosen, at most one at a place
  std::size_t at_least = 1;    ///< detections (of sensors, or of pairs) that count as one
  std::size_t draws = 1;       ///< all alike
  std::vector<double> weight;  ///< [cells] their sum is 1
  /// Probability of detection [draws × cells], cell fastest, of each candidate; with `pairs` of
  /// each two, [transmitter × candidates + receiver]. One that is not needed may be empty.
  std::vector<std::vector<float>> maps;

  [[nodiscard]] std::size_t places() const noexcept;
};

/// Indices of candidates, rising.
using SensorSet = std::vector<std::size_t>;

enum class PlacementMethod { automatic, swap, exhaustive };
inline constexpr std::string_view placement_method_words[] = {"auto", "swap", "exhaustive"};

struct PlacementSettings {
  PlacementMethod method = PlacementMethod::automatic;
  int starts = 10;          ///< drawn sets that are improved by swaps too, beside the greedy one
  std::uint64_t seed = 1;   ///< of these
  double most_sets = 2e5;   ///< that `automatic` looks at one by one …
  double most_work = 3e10;  ///< … and numbers of maps that it looks at for that: a minute
};

/// The best set that was found, and how good a better one could be.
struct PlacementChoice {
  SensorSet best;
  double value = 0.0;   ///< its share of the weight that is detected, over all draws
  SensorSet runner_up;  ///< the best of the others that were looked at; empty: there is none
  double runner_value = 0.0;
  double upper_bound = 1.0;          ///< no set is better than that
  bool proved = false;               ///< no set is better than `best`
  std::vector<SensorSet> greedy;     ///< [sensors] the first one, two, …
  std::vector<double> greedy_value;  ///< [sensors] of these
  SensorSet swapped;                 ///< the greedy set after its swaps
  double swapped_value = 0.0;
  int swaps = 0;  ///< that improved the greedy set
};

/// Sets of as many sensors as are asked for, one at a place at most.
[[nodiscard]] double number_of_sets(const PlacementProblem& problem);

/// Greedy choice (while sensors are fewer than detections that count as one, of as many as there
/// are), then the best swap of one sensor again and again until none is better; the same
/// from drawn sets. Where there are few sets, or if it is asked for, all of them (those that cannot
/// be better than the best two are left out, where one sensor more never gains more than before).
/// \throws Interrupted
[[nodiscard]] PlacementChoice choose_sensors(const PlacementProblem& problem,
                                             const PlacementSettings& settings,
                                             const Progress& progress = {});

/// Probability that at least so many of a set's maps detect, which are independent: [draws ×
/// cells].
[[nodiscard]] std::vector<double> combined_detection(const PlacementProblem& problem,
                                                     const SensorSet& set);

/// The weight's share that is detected in each draw. [draws]
[[nodiscard]] std::vector<double> shares_of(const PlacementProblem& problem, const SensorSet& set);

}  // namespace asdic::detail
