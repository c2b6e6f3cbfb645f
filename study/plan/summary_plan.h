#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/expression/expression.h"

namespace asdic::detail::study {

/// How the interval of a proportion is had.
enum class ProportionInterval { wilson, clopper_pearson };

/// An input (or measure) along which rows are put together: its values where there are at most
/// twenty or ten rows to each, else bins.
struct SummaryAxis {
  std::string column;
  std::vector<double> edges;  ///< of the bins, increasing; empty: as below
  int bins = 0;               ///< of equal width between the ends of the input's law, or from the
                              ///< least to the greatest value where it has none …; 0: by value
                              ///< where that is possible, else ten
  bool equal_count = false;   ///< … or holding equally many rows
};

/// Cells of place: east and north, or rings and sectors, for each of some depths.
struct SummaryMap {
  bool polar = false;                  ///< range and true bearing instead of east and north
  SummaryAxis across, up;              ///< east and north; range and bearing
  std::string range, bearing;          ///< columns that east and north are had from; "": from none
  std::optional<SummaryAxis> depth{};  ///< none: all depths together
};

/// A measure that is a formula of what the row holds: [summary.own].
struct OwnFormula {
  std::string name, unit = "1", meaning;
  bool event = false;                ///< happens (any value but 0, which becomes 1) or does not (0)
  std::optional<bool> least_best{};  ///< in comparisons; none: its name says
  std::optional<double> otherwise{};  ///< where a column in it is not a number; none: nor is it
  Expression expression;
  /// [expression.names()] which of columns(study), and behind them of the formulae
  std::vector<std::size_t> places{};
};

/// What is made of the rows.
struct SummaryPlan {
  double confidence = 0.95;
  ProportionInterval interval = ProportionInterval::wilson;
  std::vector<double> quantiles{0.05, 0.25, 0.5, 0.75, 0.95};
  /// Each along one axis or over two. Not given: along every input by itself.
  std::vector<std::vector<SummaryAxis>> by;
  std::vector<OwnFormula> own{};  ///< in an order in which each looks at those before it alone
  std::optional<SummaryMap> map{};
  bool roc = true;          ///< where the matched filter's answers are columns
  bool convergence = true;  ///< of the first measure
  bool sensitivity = true;  ///< of every measure to every input
};

}  // namespace asdic::detail::study
