#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "study/plan/summary_plan.h"

namespace asdic::detail::study {

struct Interval {
  double low = 0.0, high = 0.0;
};

/// z of a two-sided interval of a normal: 1.96 for 0.95.
[[nodiscard]] double two_sided(double confidence) noexcept;

/// Of a proportion, by the score test (Wilson, JASA 22, 209, 1927): never empty, never outside
/// [0, 1], its coverage near `confidence` for any count.
[[nodiscard]] Interval wilson(double successes, double count, double confidence) noexcept;

/// Of a proportion, by the binomial's own tails (Clopper & Pearson, Biometrika 26, 404, 1934): its
/// coverage is at least `confidence`. [0, 1] for a count of 0; of fractions too, the same law.
[[nodiscard]] Interval clopper_pearson(double successes, double count, double confidence);

/// Either of them; [0, 1] for a count of 0.
[[nodiscard]] Interval proportion_interval(ProportionInterval kind, double successes, double count,
                                           double confidence);

/// I_x(a, b), the regularised incomplete beta function: the continued fraction of Abramowitz &
/// Stegun 26.5.8, summed by Lentz's method. \param a, b  above 0
[[nodiscard]] double incomplete_beta(double a, double b, double x);

/// Mean and variance, one number at a time (Welford, Technometrics 4, 419, 1962).
class Moments {
 public:
  void add(double x) noexcept {
    count_ += 1.0;
    const double step = x - mean_;
    mean_ += step / count_;
    squares_ += step * (x - mean_);
  }
  [[nodiscard]] double count() const noexcept { return count_; }
  [[nodiscard]] double mean() const noexcept;       ///< NaN of none
  [[nodiscard]] double deviation() const noexcept;  ///< of the sample; NaN of fewer than two
  /// Of the mean: z standard errors to either side; NaN of fewer than two.
  [[nodiscard]] Interval mean_interval(double confidence) const noexcept;

 private:
  double count_ = 0.0, mean_ = 0.0, squares_ = 0.0;
};

/// Straight between the order statistics, the p-th of n at (n − 1)p. \param sorted  increasing, not
/// empty
[[nodiscard]] double sample_quantile(std::span<const double> sorted, double p) noexcept;

/// Ranks from 1; equal values share the mean of theirs.
[[nodiscard]] std::vector<double> ranks(std::span<const double> values);

/// Pearson's correlation; 0 where either does not vary.
[[nodiscard]] double correlation(std::span<const double> a, std::span<const double> b) noexcept;

}  // namespace asdic::detail::study
