#pragma once
#include <string>
#include <vector>

#include "core/memory_budget.h"
#include "study/comparison/paired.h"
#include "study/placement/placement_plan.h"

namespace asdic::detail::study {

/// Why no sensor may be at a place.
enum class PlaceRefused : std::int8_t { no = 0, too_shallow = 1, beyond_map = 2 };

/// The best set of sensors, and how sure that is.
struct Placement {
  PlacementProblem problem;           ///< its maps are empty, once it is solved
  PlacementChoice choice;             ///< of problem.candidates
  double sets = 0.0;                  ///< that there are to choose from
  std::vector<double> alone;          ///< [candidates] share that each detects by itself, all draws
  std::vector<PlaceRefused> refused;  ///< [plan's places] by every option

  std::vector<double> depths;        ///< of the target [m]
  std::vector<std::int8_t> protect;  ///< [depths × cells] 1: it counts; 0: no water, or off the map

  std::vector<float> floor;             ///< [cells] depth of the sea floor [m]; NaN: off the map
  std::optional<OceanOrigin> origin{};  ///< where the map is on the Earth
  std::shared_ptr<const Area> area{};   ///< that it is of

  // Over the draws that judge; without them over the one that there is.
  std::vector<double> best, runner_up;  ///< [draws] share that is detected
  PairedDifference difference;          ///< the best's less the runner-up's
  std::size_t better = 0, worse = 0;    ///< draws in which the best set is that
  std::vector<float> detection;  ///< [depths × cells] of the best set, mean; NaN: does not count
  std::vector<float> deviation;  ///< [depths × cells] of it from draw to draw; NaN of one draw
  std::vector<double> without;   ///< [sensors] share without this one of the set, mean
  double least = 0.0;            ///< the worst protected cell's probability …
  std::size_t least_cell = 0;    ///< … in depths × cells
  double below_half = 0.0;  ///< share of the weight that is detected less than half of the time
  double silent = 0.0;      ///< share of the weight to which no ray of any of the set comes
  std::vector<std::string> warnings;

  /// Whether the best set and the runner-up can be told apart.
  [[nodiscard]] bool told_apart() const noexcept {
    return difference.interval.low > 0.0 || difference.interval.high < 0.0;
  }
};

/// \throws InputError of the plan or of a scenario, Interrupted
[[nodiscard]] Placement place_sensors(const PlacementPlan& plan, const Progress& progress = {});

}  // namespace asdic::detail::study
