#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/bellhop/case_reader.h"
#include "io/files/output_file.h"

namespace asdic::detail::bellhop {

/// What a case of BELLHOP3D is as a scenario: its first plane, in an area whose maps are in a file.
struct MapScenario {
  PropagationCase run_case;
  bool maps = false;               ///< whether a file of them is wanted (write_maps())
  std::vector<std::string> notes;  ///< what the scenario does not hold
};

/// \param maps_file  where they go
/// \throws InputError  for a surface with relief, which no area has
[[nodiscard]] MapScenario map_scenario(const Input& input, const std::string& maps_file);

/// The depths and speeds of a case as an ocean area (docs/formats/ocean-area.md), on axes in m:
/// "depth" over "y", "x"; "sound_speed" over "water_depth", "water_y", "water_x".
void write_maps(OutputFile&& output, const Input& input);

}  // namespace asdic::detail::bellhop
