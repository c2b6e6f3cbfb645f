#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "io/text/toml_value.h"
#include "processing/coverage/coverage_of_scenario.h"
#include "processing/placement/placement_search.h"
#include "study/plan/study.h"

namespace asdic::detail::study {

/// One way in which a sensor may work: a scenario with what is changed in it.
struct PlacementOption {
  std::string name;
  std::filesystem::path path;  ///< of the scenario
  std::string text{};          ///< of it, verbatim
  TomlValue scenario{};        ///< with its include, what the plan sets, and the overrides
  std::optional<std::string> transmitter = {}, array = {};  ///< names
};

/// What a drawn map of a sensor is off by, beside what its inputs are.
enum class MapError {
  none,
  cells,  ///< every cell by its own uncertainty_db, independently
  maps    ///< all cells of a map together, each by its uncertainty_db: the map is too high or low
};
inline constexpr std::string_view map_error_words[] = {"none", "cells", "maps"};

/// Where sensors are to be put, and what for. docs/formats/placement.md
struct PlacementPlan {
  std::string title;
  std::size_t sensors = 1, at_least = 1;
  bool multistatic = false, across_options = false;  ///< arrays hear pings of other options too
  std::vector<PlacementOption> options;
  std::vector<Vec2> places;  ///< east, north [m]
  double clearance = 1.0;    ///< between whatever a sensor is and the sea floor, at least [m]
  double least_water = 0.0;  ///< depth of the sea at a place, at least [m]

  std::vector<Vec2> cells;            ///< their middles, east and north [m]
  std::vector<double> weights;        ///< [cells], at least 0
  double cell_size = 0.0;             ///< of the grid that they are of [m]; 0: they are points
  std::vector<double> depths;         ///< of the target [m]
  std::vector<double> depth_weights;  ///< [depths]
  AreaWishes wishes;                  ///< of the maps; their depths are those above

  MapError map_error = MapError::none;
  std::size_t draws = 1, judging = 0;  ///< that choose, and fresh ones that judge
  double confidence = 0.95;
  PlacementSettings search;
  Study inputs;  ///< what is drawn: its seed, variables and correlation are

  std::filesystem::path path;
  std::string text;
  std::vector<std::string> overrides, warnings;
};

}  // namespace asdic::detail::study
