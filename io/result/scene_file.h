#pragma once
#include <filesystem>

#include "io/hdf5/hdf5_file.h"
#include "raytrace/cases/propagation_case.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Writes what a scenario says of the sea and of who is where in it, for a drawing of it before
/// anything is computed: `filetype` "asdic scene", read by the pictures' script alone. The section
/// leaves the first transmitter towards the first target, else along the transect. Tracks go on
/// until the last record ends.
void write_scene(const std::filesystem::path& path, const Scenario& scenario);
/// The same of a run without a sonar: its sea, sources and receivers.
void write_scene(const std::filesystem::path& path, const PropagationCase& run);

/// Where platforms, transmitters, arrays and targets are: groups of these names, each with `names`
/// and `track` [things, instants, 3], until the last record ends; with `latitude` and `longitude`
/// [things, instants] where they are known.
void write_tracks(Hdf5File& file, const Scenario& scenario);

}  // namespace asdic::detail
