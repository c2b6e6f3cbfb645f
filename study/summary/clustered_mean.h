#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "study/sampling/clusters.h"
#include "study/summary/intervals.h"

// Means and ratios of rows that are not independent of one another: docs/theory/studies.md
namespace asdic::detail::study {

/// t of a two-sided interval of Student's distribution: 2.13 for 0.95 and 15 degrees of freedom.
/// \param freedom  above 0
[[nodiscard]] double student(double confidence, double freedom);

/// Mean of values that come in the order of their indices, with the interval that their clusters
/// ask for: of rows by themselves as of independent draws; else by linearisation of the ratio
/// Σs/Σn over clusters, s and n the sum and the number of a cluster's values (Cochran, Sampling
/// Techniques, 1977, ch. 6), Student's t with clusters − 1 degrees of freedom. Copyable; its memory
/// grows with replicates only.
class ClusteredMean {
 public:
  explicit ClusteredMean(const Clusters& clusters = {});

  void add(std::uint64_t index, double x);

  [[nodiscard]] const Clusters& clusters() const noexcept { return clusters_; }
  [[nodiscard]] double count() const noexcept { return moments_.count(); }
  [[nodiscard]] double mean() const noexcept { return moments_.mean(); }
  [[nodiscard]] double deviation() const noexcept { return moments_.deviation(); }

  /// NaN of fewer than two values, or of a single cluster.
  [[nodiscard]] Interval mean_interval(double confidence) const;
  /// Of values that are 0 or 1. Of clusters that of `kind` with the number of independent rows that
  /// would scatter as they do (Korn & Graubard, Survey Methodology 24, 193, 1998); of replicates
  /// never narrower than ln(2/(1 − confidence))/count to either side, however alike they are.
  [[nodiscard]] Interval proportion(ProportionInterval kind, double confidence) const;

 private:
  struct Sums {
    double count = 0.0, sum = 0.0;  ///< of the values less shift_
  };
  /// Σ over clusters of what the variance takes.
  struct Squares {
    double clusters = 0.0, ss = 0.0, sn = 0.0, nn = 0.0;
    void add(const Sums& sums) noexcept;
  };
  [[nodiscard]] Squares squares() const;
  /// Of the mean, about the clusters'. \param squares  of at least two
  [[nodiscard]] double variance(const Squares& squares) const noexcept;

  Clusters clusters_;
  Moments moments_;
  double shift_ = 0.0;            // the first value: sums stay small
  std::vector<Sums> replicates_;  // [replicates]
  std::uint64_t block_ = 0;       // that values come of
  Sums open_;                     // of this block
  Squares closed_;                // of those before it
};

/// Σn/Σv over clusters, and its interval by Fieller (J. R. Stat. Soc. B 16, 175, 1954): the ratios
/// θ for which the mean of n − θv may be 0 by Student's t. NaN where v may be 0 as well, or of
/// fewer than two clusters.
struct Ratio {
  double value = 0.0;
  Interval interval;
};
[[nodiscard]] Ratio ratio_of(std::span<const double> n, std::span<const double> v,
                             double confidence);

}  // namespace asdic::detail::study
