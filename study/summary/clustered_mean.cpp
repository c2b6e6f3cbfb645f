#include "study/summary/clustered_mean.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/plan/no_value.h"

namespace asdic::detail::study {

double student(double confidence, double freedom) {
  if (freedom > 300.0) {
    // Abramowitz & Stegun 26.7.5: below 10⁻⁷ of t from here on.
    const double z = two_sided(confidence), z2 = z * z, f = freedom;
    return z + z * (z2 + 1.0) / (4.0 * f) + z * ((5.0 * z2 + 16.0) * z2 + 3.0) / (96.0 * f * f) +
           z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / (384.0 * f * f * f);
  }
  // P(|T| > t) = I_x(f/2, 1/2) at x = f/(f + t²): increasing in x, found by halving.
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (incomplete_beta(0.5 * freedom, 0.5, middle) < 1.0 - confidence ? low : high) = middle;
  }
  const double x = 0.5 * (low + high);
  return std::sqrt(freedom * (1.0 - x) / x);
}

ClusteredMean::ClusteredMean(const Clusters& clusters) : clusters_(clusters) {
  if (clusters_.kind == Clusters::Kind::replicates) replicates_.resize(clusters_.size);
}

void ClusteredMean::Squares::add(const Sums& sums) noexcept {
  if (!(sums.count > 0.0)) return;
  clusters += 1.0;
  ss += sums.sum * sums.sum;
  sn += sums.sum * sums.count;
  nn += sums.count * sums.count;
}

void ClusteredMean::add(std::uint64_t index, double x) {
  if (!(moments_.count() > 0.0)) shift_ = x;
  moments_.add(x);
  if (clusters_.kind == Clusters::Kind::rows) return;
  const std::uint64_t cluster = clusters_.of(index);
  if (clusters_.kind == Clusters::Kind::blocks && cluster != block_) {
    closed_.add(open_);
    open_ = {};
    block_ = cluster;
  }
  Sums& sums = clusters_.kind == Clusters::Kind::blocks ? open_ : replicates_[cluster];
  sums.count += 1.0;
  sums.sum += x - shift_;
}

ClusteredMean::Squares ClusteredMean::squares() const {
  Squares all = closed_;
  all.add(open_);
  for (const Sums& sums : replicates_) all.add(sums);
  return all;
}

double ClusteredMean::variance(const Squares& all) const noexcept {
  const double n = moments_.count(), mean = moments_.mean() - shift_;
  double scatter = all.ss - 2.0 * mean * all.sn + mean * mean * all.nn;
  if (clusters_.kind == Clusters::Kind::replicates) {  // may be alike to many digits
    scatter = 0.0;
    for (const Sums& sums : replicates_) {
      const double d = sums.sum - mean * sums.count;
      scatter += d * d;
    }
  }
  // What is left of blocks that are all alike is rounding.
  if (scatter < 4e-15 * (all.ss + mean * mean * all.nn) && clusters_.kind == Clusters::Kind::blocks)
    scatter = 0.0;
  return all.clusters / (all.clusters - 1.0) * scatter / (n * n);
}

Interval ClusteredMean::mean_interval(double confidence) const {
  if (clusters_.kind == Clusters::Kind::rows) return moments_.mean_interval(confidence);
  const Squares all = squares();
  if (all.clusters < 2.0) return {no_value, no_value};
  const double half = student(confidence, all.clusters - 1.0) * std::sqrt(variance(all));
  return {mean() - half, mean() + half};
}

Interval ClusteredMean::proportion(ProportionInterval kind, double confidence) const {
  const double n = count(), p = mean();
  if (clusters_.kind == Clusters::Kind::rows || !(n > 0.0))
    return proportion_interval(kind, n > 0.0 ? std::round(p * n) : 0.0, n, confidence);
  const Squares all = squares();
  const bool replicates = clusters_.kind == Clusters::Kind::replicates;
  // Where nothing tells how much they scatter: a block counts once, rows of replicates each.
  double rows = replicates ? n : all.clusters;
  if (all.clusters > 1.0) {
    const double of_mean = variance(all), of_one = p * (1.0 - p);
    if (of_mean > 1e-14 * of_one / n && of_one > 0.0) {
      const double z = two_sided(confidence) / student(confidence, all.clusters - 1.0);
      rows = of_one / of_mean * z * z;
      // Beyond n² the least width below is wider, beyond 10⁸ the beta distribution's tails are
      // slow.
      rows = std::min(rows, replicates ? std::max(n, std::min(n * n, 1e8)) : n);
    }
  }
  Interval interval = proportion_interval(kind, p * rows, rows, confidence);
  if (replicates) {
    const double least = std::log(2.0 / (1.0 - confidence)) / n;
    interval.low = std::min(interval.low, std::max(0.0, p - least));
    interval.high = std::max(interval.high, std::min(1.0, p + least));
  }
  return interval;
}

Ratio ratio_of(std::span<const double> n, std::span<const double> v, double confidence) {
  const auto count = static_cast<double>(n.size());
  const double mean_n = std::accumulate(n.begin(), n.end(), 0.0) / count;
  const double mean_v = std::accumulate(v.begin(), v.end(), 0.0) / count;
  if (!(count > 1.0) || !(mean_v > 0.0)) return {no_value, {no_value, no_value}};
  double nn = 0.0, nv = 0.0, vv = 0.0;  // the covariances of the means
  for (std::size_t i = 0; i < n.size(); ++i) {
    nn += (n[i] - mean_n) * (n[i] - mean_n);
    nv += (n[i] - mean_n) * (v[i] - mean_v);
    vv += (v[i] - mean_v) * (v[i] - mean_v);
  }
  const double t = student(confidence, count - 1.0), g = t * t / (count * (count - 1.0));
  // (n̄ − θv̄)² = t²·Var(n̄ − θv̄)
  const double a = mean_v * mean_v - g * vv, b = mean_n * mean_v - g * nv,
               c = mean_n * mean_n - g * nn;
  const double inside = std::max(0.0, b * b - a * c);
  if (!(a > 0.0)) return {mean_n / mean_v, {no_value, no_value}};
  return {mean_n / mean_v, {(b - std::sqrt(inside)) / a, (b + std::sqrt(inside)) / a}};
}

}  // namespace asdic::detail::study
