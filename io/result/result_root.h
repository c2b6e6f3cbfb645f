#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/hdf5/hdf5_file.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// The scenario that results were made of.
struct ResultOrigin {
  std::string title{}, path{}, text{};
  std::vector<std::string> overrides{};
  std::vector<std::string> warnings{};  ///< that were told of it
  std::optional<OceanOrigin> origin{};  ///< where it is on the Earth, if it says so
};

[[nodiscard]] ResultOrigin origin_of(const Scenario& scenario);

/// What every file of results tells of itself: filetype, version, title, program, and the scenario.
void write_root(Hdf5File& file, const std::string& filetype, const ResultOrigin& origin);

}  // namespace asdic::detail
