#pragma once
#include "study/summary/intervals.h"

// What two answers to the same realisations differ by.
namespace asdic::detail::study {

/// Realisations in which something happened with the first alone, with the second alone, and all.
struct PairedCounts {
  double only_first = 0.0, only_second = 0.0, all = 0.0;
};

/// The second less the first.
struct PairedDifference {
  double value = 0.0;  ///< NaN of no pairs
  Interval interval{};
  double p_value = 1.0;  ///< of a difference as large or larger, both ways, where there is none
};

/// Of two proportions of the same realisations: the score interval (Tango, Stat. Med. 17, 891,
/// 1998), and McNemar's test by the binomial law of the pairs that differ, exact.
[[nodiscard]] PairedDifference difference_of_proportions(const PairedCounts& pairs,
                                                         double confidence);

/// Of two means: Student's interval and test of the pairs' differences. \param differences  the
/// second less the first, of each pair
[[nodiscard]] PairedDifference difference_of_means(const Moments& differences, double confidence);

}  // namespace asdic::detail::study
