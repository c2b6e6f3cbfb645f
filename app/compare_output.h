#pragma once
#include <string>
#include <variant>
#include <vector>

#include "io/compare/arrivals.h"
#include "io/compare/fields.h"
#include "io/compare/rays.h"

namespace asdic::detail::app {

using Comparison =
    std::variant<compare::FieldDifference, compare::ArrivalDifference, compare::RayDifference>;

/// What was compared, and how it came out.
struct CompareResult {
  std::string a, b;  ///< names of the files
  Comparison comparison;
  double floor_db = 0.0, below_strongest_db = 0.0;  ///< as asked for
  bool within = true;                               ///< all thresholds
  std::vector<std::string> exceeded;                ///< those that are not, in words
  std::vector<std::string> missed;  ///< the strongest paths that A has not, in words
};

[[nodiscard]] std::string comparison_table(const CompareResult& result);
[[nodiscard]] std::string comparison_json(const CompareResult& result);

}  // namespace asdic::detail::app
