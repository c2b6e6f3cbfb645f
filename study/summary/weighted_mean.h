#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "study/sampling/clusters.h"
#include "study/summary/clustered_mean.h"
#include "study/summary/intervals.h"

// Means of rows that were not drawn from the inputs' own laws: docs/theory/rare-events.md
namespace asdic::detail::study {

/// P(a, x), the regularised incomplete gamma function. \param a  above 0
[[nodiscard]] double incomplete_gamma(double a, double x);
/// The x at which P(a, x) = p. \param p  in (0, 1)
[[nodiscard]] double gamma_quantile(double a, double p);

/// Of a probability that a sum of weights estimates: the gamma interval of Fay & Feuer (Stat. Med.
/// 16, 791, 1997), which is Garwood's exact one of a Poisson count where all weights are alike.
/// \param estimate  above 0   \param variance  of it, above 0
/// \param largest  what one more row of the largest weight would add to it
[[nodiscard]] Interval gamma_interval(double estimate, double variance, double largest,
                                      double confidence);

/// The least value with a share p of the weights at or below it; NaN where they have no weight.
/// \param sorted  [n] values, increasing, and their weights
[[nodiscard]] double weighted_quantile(std::span<const std::pair<double, double>> sorted, double p);

/// Mean of values with weights w, the quotient of the density that is meant and that from which
/// rows were drawn; E[w] = 1. Copyable; its memory grows with replicates only.
class WeightedMean {
 public:
  /// Of what the mean is.
  enum class Of {
    all_rows,  ///< of every row that was drawn: of 0 and 1 Σwy/n, without bias
    a_part     ///< of rows in a bin, whose probability is not known: Σwy/Σw
  };
  explicit WeightedMean(const Clusters& clusters = {}, Of of = Of::a_part);

  void add(std::uint64_t index, double x, double weight);
  /// A row whose value is not known: the mean is that given that it is known.
  void leave_out(std::uint64_t index, double weight);

  [[nodiscard]] double count() const noexcept { return all_.known; }
  /// (Σw)²/Σw² of the rows that count.
  [[nodiscard]] double effective() const noexcept;

  // Of any numbers: Σwy/Σw.
  [[nodiscard]] double mean() const noexcept;
  [[nodiscard]] double deviation() const noexcept;
  /// By linearisation of the quotient, Student's t with effective() − 1 degrees of freedom or, of
  /// replicates, as many less 1 as there are.
  [[nodiscard]] Interval mean_interval(double confidence) const;

  // Of values that are 0 or 1.
  /// Of the rarer of both, and what is left to 1 of the other.
  [[nodiscard]] double probability() const noexcept;
  [[nodiscard]] Interval probability_interval(double confidence) const;
  /// Rows of the rarer of both.
  [[nodiscard]] double rows_of_event() const noexcept;
  /// (Σwy)²/Σ(wy)² of the rarer of both.
  [[nodiscard]] double effective_of_event() const noexcept;
  /// The largest share of Σwy that one row has, of the rarer of both. NaN: there is none.
  [[nodiscard]] double largest_share() const noexcept;

 private:
  struct Sums {
    double rows = 0.0, known = 0.0;                     ///< of all, and of those with a value
    double w = 0.0, ww = 0.0;                           ///< of known ones
    double u = 0.0, uu = 0.0;                           ///< weights of those that are not known
    double wy = 0.0, wwy = 0.0, wyy = 0.0, wwyy = 0.0;  ///< y: values less shift_
  };
  /// Of one of the two outcomes.
  struct Event {
    double rows = 0.0, sum = 0.0, squares = 0.0, largest = 0.0;
    double estimate = 0.0, divisor = 1.0;
    bool is_one = true;
  };
  [[nodiscard]] Event outcome(bool one) const noexcept;
  [[nodiscard]] Event rarer() const noexcept;
  [[nodiscard]] double variance_of(const Event& event) const noexcept;

  Clusters clusters_;
  Of of_;
  Sums all_;
  double shift_ = 0.0;
  double largest_one_ = 0.0, largest_zero_ = 0.0;
  double ones_ = 0.0, w_one_ = 0.0, ww_one_ = 0.0;  // rows whose value is 1
  struct Replicate {
    double rows = 0.0, w = 0.0, wy = 0.0, one = 0.0, u = 0.0;
  };
  std::vector<Replicate> replicates_;
};

/// A mean of rows, with weights or without.
class RowMean {
 public:
  /// \param weighted  whether rows come with weights; without, it is ClusteredMean to the bit
  RowMean(const Clusters& clusters, bool weighted, WeightedMean::Of of = WeightedMean::Of::a_part)
      : weighted_(weighted), plain_(clusters), with_weights_(clusters, of) {}

  void add(std::uint64_t index, double x, double weight = 1.0) {
    if (weighted_)
      with_weights_.add(index, x, weight);
    else
      plain_.add(index, x);
  }
  void leave_out(std::uint64_t index, double weight) {
    if (weighted_) with_weights_.leave_out(index, weight);
  }
  [[nodiscard]] const Clusters& clusters() const noexcept { return plain_.clusters(); }
  [[nodiscard]] double count() const noexcept {
    return weighted_ ? with_weights_.count() : plain_.count();
  }
  /// \param proportion  of values that are 0 or 1
  [[nodiscard]] double value(bool proportion) const noexcept {
    if (!weighted_) return plain_.mean();
    return proportion ? with_weights_.probability() : with_weights_.mean();
  }
  [[nodiscard]] double deviation() const noexcept {
    return weighted_ ? with_weights_.deviation() : plain_.deviation();
  }
  [[nodiscard]] Interval interval(bool proportion, ProportionInterval kind,
                                  double confidence) const {
    if (weighted_)
      return proportion ? with_weights_.probability_interval(confidence)
                        : with_weights_.mean_interval(confidence);
    return proportion ? plain_.proportion(kind, confidence) : plain_.mean_interval(confidence);
  }
  [[nodiscard]] const WeightedMean& weighted() const noexcept { return with_weights_; }

 private:
  bool weighted_;
  ClusteredMean plain_;
  WeightedMean with_weights_;
};

}  // namespace asdic::detail::study
