#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "study/summary/intervals.h"

// What a few rows tell of all: docs/theory/studies.md, "the cost of a study"
namespace asdic::detail::study {

/// Largest ratio of an upper bound to its estimate. A larger bound is replaced by NaN, because it
/// is a guess at the law's tail that so few or so uneven rows do not support.
inline constexpr double most_supported = 10.0;

/// What all rows cost together, and between what bounds.
struct Predicted {
  double total = 0.0;
  Interval interval{};
};

/// Σ of the costs of `count` rows, of which some are known.
///
/// The mean of those known stands for the rest. Its interval is the wider of two at either end:
/// Student's t, and Cox's of a log-normal law (Zhou & Gao, Stat. Med. 16, 783, 1997), as costs are
/// skewed and rows few. Both with the scatter of the rest itself, so that nothing is left to
/// predict where all rows are known. The upper bound is NaN beyond most_supported.
/// \param groups  [groups] mean costs of rows of a group, the groups independent of one another and
/// of one size \param rows  of a group \param count  of all rows, at least those that are known
[[nodiscard]] Predicted predicted_total(std::span<const double> groups, std::uint64_t rows,
                                        std::uint64_t count, double confidence);

/// The greatest of `count` rows: of a log-normal law its median, and between what bounds.
///
/// ln of the greatest of n normal values is about μ + zσ, z the normal deviate over which one of n
/// lies half of the time. With μ and σ of m known values it errs by σ√(1/m + z²/(2m − 2)), and it
/// scatters by itself by σπ/(√6 z) (Gumbel); Student's t of both. The estimate is at least the
/// greatest row that is known. The upper bound is NaN for a single row and beyond most_supported.
/// Where the median itself lies beyond that, the greatest known row takes its place.
/// Source: docs/theory/studies.md
/// \param known  of rows that were tried, each taken for `least` at least: where rows take next to
/// nothing their ratios mean nothing
[[nodiscard]] Predicted predicted_greatest(std::span<const double> known, std::uint64_t count,
                                           double confidence, double least);

/// Which rows to try of `count`: `groups` runs of `rows` indices each, one run in each of as many
/// equal parts of the study, at random there (the same ones for the same numbers), rising. All
/// rows, where there are no more. \param rows  runs begin at multiples of it
[[nodiscard]] std::vector<std::uint64_t> rows_to_try(std::uint64_t count, std::uint64_t groups,
                                                     std::uint64_t rows);

}  // namespace asdic::detail::study
