#pragma once
#include <optional>
#include <string>
#include <vector>

#include "processing/coverage/coverage.h"

namespace asdic::detail {

/// What somebody asks of a picture of the area; what he leaves open is the scenario's.
struct AreaWishes {
  std::vector<double> depths = {};              ///< none: the first target's [m]
  std::optional<double> reach = {};             ///< none: as far as the record hears [m]
  std::optional<double> strength_db = {};       ///< none: the first target's, or 10
  std::optional<std::string> fluctuation = {};  ///< none: the first target's
  std::optional<std::string> transmitter = {}, array = {};  ///< names
  std::optional<int> ping = {};                             ///< from 1
  int bearings = 360, ranges = 500;
  double false_alarm_probability = 1e-4;
  double reference_cells = 24.0;  ///< 0: the background is known
};

/// \throws InputError naming the option at fault: "--array"
[[nodiscard]] CoverageSettings coverage_settings(const Scenario& scenario,
                                                 const AreaWishes& wishes);

}  // namespace asdic::detail
