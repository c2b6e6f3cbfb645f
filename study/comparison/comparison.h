#pragma once
#include <string>
#include <vector>

#include "study/plan/study.h"
#include "study/summary/summary.h"

namespace asdic::detail::study {

/// A study that is compared with others, and its rows.
struct Compared {
  std::string name;  ///< "hull_mounted", as columns begin; [a-z0-9_]
  const Study* study = nullptr;
  Table table;  ///< inputs and measures
};

/// What several studies of the same realisations differ by.
struct Comparison {
  std::size_t rows = 0;                    ///< that all have
  std::vector<std::string> inputs;         ///< that all have, with the same values in every row
  std::vector<std::string> unlike_inputs;  ///< that several have, with other values
  std::vector<std::string> measures;       ///< that all have
  Summary summary;
};

/// Compares studies row by row: rows of one index have drawn the same numbers, so they share the
/// sea, and what they differ by is known better than either (common random numbers). Tables:
/// "differences" of every measure; of each axis that [summary] of the first study has, and each
/// measure, "pd_by_range", …. Columns of a study NAME: pd_NAME with its interval; of each pair
/// A_to_B (B less A) with its interval and p-value; `best`: which study is better than each other
/// by its interval. Source: docs/theory/studies.md, eq. (22)–(23)
/// \param studies  two or more, of one seed and
/// design \throws InputError where there is nothing to compare
[[nodiscard]] Comparison compare(const std::vector<Compared>& studies);

/// Names for columns, out of paths: their stems in [a-z0-9_]; numbers behind those that are alike.
[[nodiscard]] std::vector<std::string> names_of(const std::vector<std::string>& paths);

/// "range_error": the smaller the better.
[[nodiscard]] bool least_is_best(const Column& measure) noexcept;

/// Before its rows are made: \throws InputError for a study that has weights, since pairs have none
void check_comparable(const Study& study);

}  // namespace asdic::detail::study
