#pragma once
#include <string>
#include <vector>

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

/// What is made of the rows.
struct SummaryPlan {
  double confidence = 0.95;
  ProportionInterval interval = ProportionInterval::wilson;
  std::vector<double> quantiles{0.05, 0.25, 0.5, 0.75, 0.95};
  /// Each along one axis or over two. Not given: along every input by itself.
  std::vector<std::vector<SummaryAxis>> by;
  bool roc = true;          ///< where the matched filter's answers are columns
  bool convergence = true;  ///< of the first measure
  bool sensitivity = true;  ///< of every measure to every input
};

}  // namespace asdic::detail::study
