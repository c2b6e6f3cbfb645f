#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/hdf5/hdf5_output.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::app {

/// The scenario that results were made of.
struct ResultOrigin {
  std::string title{}, path{}, text{};
  std::vector<std::string> overrides{};
  std::vector<std::string> warnings{};  ///< that were told of it
  std::optional<OceanOrigin> origin{};  ///< where it is on the Earth, if it says so
};

/// That a name does not end like a file of BELLHOP's of another kind (.arr .ray .shd), which would
/// hold HDF5 then. \param own  the one ending a command writes, or "" \throws InputError
void check_kind(const std::filesystem::path& path, std::string_view own);

[[nodiscard]] ResultOrigin origin_of(const Scenario& scenario);

/// What every file of results tells of itself: filetype, version, title, program, and the scenario.
void write_root(Hdf5File& file, const std::string& filetype, const ResultOrigin& origin);

}  // namespace asdic::detail::app
