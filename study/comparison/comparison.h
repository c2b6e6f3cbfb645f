#pragma once
#include <string>
#include <vector>

#include "study/plan/study.h"
#include "study/summary/summary.h"
#include "study/summary/until.h"

namespace asdic::detail::study {

/// A study that is compared with others, and its rows.
struct Compared {
  std::string name;  ///< "hull_mounted", as columns begin; [a-z0-9_]
  const Study* study = nullptr;
  Table table;  ///< inputs and measures
};

/// Which of two answers is better.
enum class Better {
  greatest,
  least,
  neither  ///< nobody can say (a noise level): `best` is the greatest
};
[[nodiscard]] Better better(const Column& measure) noexcept;

/// What several studies of the same realisations differ by.
struct Comparison {
  std::size_t rows = 0;                    ///< that all have
  std::vector<std::string> inputs;         ///< that all have, with the same values in every row
  std::vector<std::string> unlike_inputs;  ///< that several have, with other values
  std::vector<std::string> measures;       ///< that all have
  std::vector<Better> better;              ///< [measures]
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

/// The realisations after which a comparison looks whether it knows enough: 100, 200, 500, 1000, …
/// and the last; of replicates as is_look(). \param count  of all
[[nodiscard]] std::vector<std::uint64_t> rounds_of(const Study& study, std::uint64_t count);

/// How well a comparison knows what the studies differ by: of each pair, in each bin, the worst.
/// \param columns  answer_columns() of the first study \param comparison  of rules with the
/// confidence that they ask for \param target  of an Until of the first study
[[nodiscard]] Known known_difference(const std::vector<Column>& columns,
                                     const Comparison& comparison,
                                     const std::vector<std::string>& names,
                                     const UntilTarget& target);

/// Before its rows are made: \throws InputError for a study that has weights, since pairs have none
void check_comparable(const Study& study);

}  // namespace asdic::detail::study
