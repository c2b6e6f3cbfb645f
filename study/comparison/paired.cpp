#include "study/comparison/paired.h"

#include <algorithm>
#include <cmath>

#include "study/plan/no_value.h"
#include "study/summary/clustered_mean.h"

namespace asdic::detail::study {
namespace {

/// The score of a difference δ = P(second alone) − P(first alone): what was seen less what δ
/// expects, over its deviation where the two probabilities are as likely as δ lets them be. It
/// falls as δ grows.
double score(const PairedCounts& pairs, double delta) {
  const double n = pairs.all, x = pairs.only_second, y = pairs.only_first;
  // 2n·q² + b·q − y·δ(1 − δ) = 0 of q = P(first alone).
  const double b = delta * (2.0 * n - x + y) - (x + y), c = -y * delta * (1.0 - delta);
  const double root = std::sqrt(std::max(0.0, b * b - 8.0 * n * c));
  const double q = std::max({0.0, -delta, (root - b) / (4.0 * n)});
  const double variance = n * (2.0 * q + delta * (1.0 - delta));
  const double seen = x - y - n * delta;
  if (variance > 0.0) return seen / std::sqrt(variance);
  return seen == 0.0 ? 0.0 : std::copysign(1e300, seen);
}

/// Where the falling score has this value, by halving.
double where_score_is(const PairedCounts& pairs, double value) {
  double low = -1.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (score(pairs, middle) > value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

PairedDifference difference_of_proportions(const PairedCounts& pairs, double confidence) {
  if (!(pairs.all > 0.0)) return {no_value, {-1.0, 1.0}, 1.0};
  const double z = two_sided(confidence), x = pairs.only_second, y = pairs.only_first;
  PairedDifference found{.value = (x - y) / pairs.all};
  found.interval = {where_score_is(pairs, z), where_score_is(pairs, -z)};
  // P(X ≤ k) of n fair coins is I_½(n − k, k + 1).
  const double n = x + y, k = std::min(x, y);
  if (n > 0.0) found.p_value = std::min(1.0, 2.0 * incomplete_beta(n - k, k + 1.0, 0.5));
  return found;
}

PairedDifference difference_of_means(const Moments& differences, double confidence) {
  const double mean = differences.mean(), n = differences.count();
  if (n < 2.0) return {mean, {no_value, no_value}, no_value};
  const double error = differences.deviation() / std::sqrt(n);
  const double half = student(confidence, n - 1.0) * error;
  PairedDifference found{.value = mean, .interval = {mean - half, mean + half}};
  if (!(error > 0.0)) {
    found.p_value = mean == 0.0 ? 1.0 : 0.0;
    return found;
  }
  // P(|t| > T) = I_{ν/(ν + T²)}(ν/2, ½).
  const double freedom = n - 1.0, t = mean / error;
  found.p_value = incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
  return found;
}

}  // namespace asdic::detail::study
