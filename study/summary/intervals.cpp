#include "study/summary/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "study/plan/no_value.h"
#include "study/sampling/law.h"

namespace asdic::detail::study {
namespace {

/// The continued fraction of I_x(a, b), for x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto guarded = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1.0, d = 1.0 / guarded(1.0 - (a + b) * x / (a + 1.0)), f = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / guarded(1.0 + even * d);
    c = guarded(1.0 + even / c);
    f *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / guarded(1.0 + odd * d);
    c = guarded(1.0 + odd / c);
    f *= c * d;
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return f;
}

/// The x at which I_x(a, b) = p, by halving: 60 halvings leave nothing of a double.
double beta_quantile(double a, double b, double p) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (incomplete_beta(a, b, middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double two_sided(double confidence) noexcept {
  return normal_upper_quantile(0.5 * (1.0 - confidence));
}

Interval wilson(double successes, double count, double confidence) noexcept {
  // |p̂ − p| = z√(p(1 − p)/n), solved for p.
  const double z = two_sided(confidence), p = successes / count, share = z * z / count;
  const double centre = (p + 0.5 * share) / (1.0 + share);
  const double half = z * std::sqrt(p * (1.0 - p) / count + 0.25 * share / count) / (1.0 + share);
  return {successes > 0.0 ? std::max(0.0, centre - half) : 0.0,
          successes < count ? std::min(1.0, centre + half) : 1.0};
}

Interval clopper_pearson(double successes, double count, double confidence) {
  const double tail = 0.5 * (1.0 - confidence), failures = count - successes;
  return {successes > 0.0 ? beta_quantile(successes, failures + 1.0, tail) : 0.0,
          failures > 0.0 ? beta_quantile(successes + 1.0, failures, 1.0 - tail) : 1.0};
}

Interval proportion_interval(ProportionInterval kind, double successes, double count,
                             double confidence) {
  if (!(count > 0.0)) return {0.0, 1.0};
  return kind == ProportionInterval::wilson ? wilson(successes, count, confidence)
                                            : clopper_pearson(successes, count, confidence);
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

double Moments::mean() const noexcept { return count_ > 0.0 ? mean_ : no_value; }

double Moments::deviation() const noexcept {
  return count_ > 1.0 ? std::sqrt(squares_ / (count_ - 1.0)) : no_value;
}

Interval Moments::mean_interval(double confidence) const noexcept {
  const double half = two_sided(confidence) * deviation() / std::sqrt(count_);
  return {mean() - half, mean() + half};
}

double sample_quantile(std::span<const double> sorted, double p) noexcept {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = std::min(sorted.size() - 1, static_cast<std::size_t>(place));
  const auto above = std::min(sorted.size() - 1, below + 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && !(values[order[i]] < values[order[end]])) ++end;
    for (std::size_t k = i; k < end; ++k)
      result[order[k]] = 0.5 * (static_cast<double>(i) + static_cast<double>(end) + 1.0);
    i = end;
  }
  return result;
}

double correlation(std::span<const double> a, std::span<const double> b) noexcept {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

}  // namespace asdic::detail::study
