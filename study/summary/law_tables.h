#pragma once
#include <string>
#include <vector>

#include "study/plan/study.h"
#include "study/summary/table.h"

namespace asdic::detail::study {

/// How a column of an input is distributed, for whoever lays it over a histogram, or weighs rows
/// anew for another law.
struct LawTable {
  std::string column, unit, meaning;
  std::vector<std::string> labels{};  ///< of values that are names
  std::string law{};                  ///< as the study file has it, in TOML
  std::string given{};                ///< of a case: "season: winter"; "": of all rows
  std::string how{};                  ///< "closed form", "50000 draws", …
  bool discrete = false;              ///< `share` is of a probability, else of a density
  std::vector<double> value{}, share{}, cumulative{};  ///< [values] P(X ≤ value) is the last one
};

/// Those of all inputs, in the order of their columns; behind one whose law depends on another
/// input, those of its cases.
[[nodiscard]] std::vector<LawTable> law_tables(const Study& study);

/// Of an input whose law depends on others by formulae: its density at what each row drew, given
/// what that row's others drew.
struct RowDensity {
  std::string column, unit;
  std::vector<double> density;  ///< [rows]
};
/// \param table  its columns are found by their names
[[nodiscard]] std::vector<RowDensity> row_densities(const Study& study, const Table& table);

}  // namespace asdic::detail::study
