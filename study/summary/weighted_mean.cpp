#include "study/summary/weighted_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/plan/no_value.h"
#include "study/sampling/law.h"

namespace asdic::detail::study {
namespace {

constexpr double enough_rows = 10.0;  // of an event, as many of one weight, to bound it from above

/// Σ of the series of P(a, x), x < a + 1 (Abramowitz & Stegun 6.5.29).
double gamma_series(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (int n = 1; n < 100000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
  return sum;
}

/// The continued fraction of Q(a, x), x > a + 1 (Abramowitz & Stegun 6.5.31), by Lentz's method.
double gamma_fraction(double a, double x) {
  constexpr double tiny = 1e-300;
  double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, f = d;
  for (int n = 1; n < 100000; ++n) {
    const double step = -n * (n - a);
    b += 2.0;
    d = step * d + b;
    d = 1.0 / (std::abs(d) < tiny ? tiny : d);
    c = b + step / c;
    if (std::abs(c) < tiny) c = tiny;
    f *= c * d;
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return f;
}

}  // namespace

double incomplete_gamma(double a, double x) {
  if (!(x > 0.0)) return 0.0;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  return x < a + 1.0 ? front * gamma_series(a, x) : 1.0 - front * gamma_fraction(a, x);
}

double gamma_quantile(double a, double p) {
  const double z = normal_score(p);
  // Wilson & Hilferty, PNAS 17, 684 (1931): for large a it is all that is needed.
  const double cube = 1.0 - 1.0 / (9.0 * a) + z / (3.0 * std::sqrt(a));
  if (a > 1e4) return a * cube * cube * cube;
  double low = 0.0, high = a + 1.0;
  while (incomplete_gamma(a, high) < p) high *= 2.0;
  for (int i = 0; i < 80 && high - low > 1e-13 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (incomplete_gamma(a, middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Interval gamma_interval(double estimate, double variance, double largest, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const double up = estimate + largest, up_variance = variance + largest * largest;
  return {variance / estimate * gamma_quantile(estimate * estimate / variance, tail),
          up_variance / up * gamma_quantile(up * up / up_variance, 1.0 - tail)};
}

double weighted_quantile(std::span<const std::pair<double, double>> sorted, double p) {
  double sum = 0.0, before = 0.0;
  for (const auto& [value, weight] : sorted) sum += weight;
  if (!(sum > 0.0)) return no_value;
  for (const auto& [value, weight] : sorted)
    if ((before += weight) >= p * sum) return value;
  return sorted.back().first;
}

WeightedMean::WeightedMean(const Clusters& clusters, Of of) : clusters_(clusters), of_(of) {
  if (clusters_.kind == Clusters::Kind::replicates) replicates_.resize(clusters_.size);
}

void WeightedMean::add(std::uint64_t index, double x, double weight) {
  if (!(all_.known > 0.0)) shift_ = x;
  const double y = x - shift_, w = weight;
  all_.rows += 1.0;
  all_.known += 1.0;
  all_.w += w;
  all_.ww += w * w;
  all_.wy += w * y;
  all_.wwy += w * w * y;
  all_.wyy += w * y * y;
  all_.wwyy += w * w * y * y;
  const bool one = x == 1.0;
  if (one) {
    ones_ += 1.0;
    w_one_ += w;
    ww_one_ += w * w;
  }
  double& largest = one ? largest_one_ : largest_zero_;
  largest = std::max(largest, w);
  if (clusters_.kind != Clusters::Kind::replicates) return;
  Replicate& here = replicates_[clusters_.of(index)];
  here.rows += 1.0;
  here.w += w;
  here.wy += w * y;
  here.one += one ? w : 0.0;
}

void WeightedMean::leave_out(std::uint64_t index, double weight) {
  all_.rows += 1.0;
  all_.u += weight;
  all_.uu += weight * weight;
  if (clusters_.kind != Clusters::Kind::replicates) return;
  Replicate& here = replicates_[clusters_.of(index)];
  here.rows += 1.0;
  here.u += weight;
}

double WeightedMean::effective() const noexcept {
  return all_.ww > 0.0 ? all_.w * all_.w / all_.ww : 0.0;
}

double WeightedMean::mean() const noexcept {
  return all_.w > 0.0 ? shift_ + all_.wy / all_.w : no_value;
}

double WeightedMean::deviation() const noexcept {
  const double n = effective();
  if (!(n > 1.0)) return no_value;
  const double m = all_.wy / all_.w;
  return std::sqrt(std::max(0.0, all_.wyy / all_.w - m * m) * n / (n - 1.0));
}

Interval WeightedMean::mean_interval(double confidence) const {
  const double n = effective(), m = all_.wy / all_.w;
  double variance = 0.0, freedom = n - 1.0;
  if (clusters_.kind == Clusters::Kind::replicates) {
    double clusters = 0.0, scatter = 0.0;
    for (const Replicate& one : replicates_) {
      if (!(one.w > 0.0)) continue;
      clusters += 1.0;
      const double d = one.wy - m * one.w;
      scatter += d * d;
    }
    freedom = clusters - 1.0;
    variance = clusters / freedom * scatter / (all_.w * all_.w);
  } else {
    // Σw²(y − m)²/(Σw)²
    const double scatter = std::max(0.0, all_.wwyy - 2.0 * m * all_.wwy + m * m * all_.ww);
    variance = scatter / (all_.w * all_.w) * n / freedom;
  }
  if (!(freedom > 0.0)) return {no_value, no_value};
  const double half = student(confidence, freedom) * std::sqrt(variance);
  return {mean() - half, mean() + half};
}

WeightedMean::Event WeightedMean::outcome(bool one) const noexcept {
  Event event{.rows = one ? ones_ : all_.known - ones_,
              .sum = one ? w_one_ : std::max(0.0, all_.w - w_one_),
              .squares = one ? ww_one_ : std::max(0.0, all_.ww - ww_one_),
              .largest = one ? largest_one_ : largest_zero_,
              .is_one = one};
  if (!(event.rows > 0.0)) event.sum = event.squares = 0.0;  // not what rounding leaves
  // What is known has the probability 1 − E[w of the others], whose estimate has no bias either.
  event.divisor = of_ == Of::a_part ? all_.w : std::max(all_.rows - all_.u, 0.5 * all_.w);
  event.estimate = event.sum / event.divisor;
  return event;
}

WeightedMean::Event WeightedMean::rarer() const noexcept {
  const Event one = outcome(true), zero = outcome(false);
  return zero.estimate < one.estimate ? zero : one;
}

/// Of its estimate.
double WeightedMean::variance_of(const Event& event) const noexcept {
  const double p = event.estimate, d = event.divisor;
  if (clusters_.kind == Clusters::Kind::replicates) {
    double clusters = 0.0, scatter = 0.0;
    for (const Replicate& here : replicates_) {
      if (!(here.rows > 0.0)) continue;
      clusters += 1.0;
      const double sum = event.is_one ? here.one : here.w - here.one;
      const double off = sum - p * (of_ == Of::a_part ? here.w : here.rows - here.u);
      scatter += off * off;
    }
    return clusters > 1.0 ? clusters / (clusters - 1.0) * scatter / (d * d) : 0.0;
  }
  if (of_ == Of::a_part)  // Σw²(y − p)²
    return (event.squares * (1.0 - 2.0 * p) + p * p * all_.ww) / (d * d);
  // Σ(wy + pu − their mean)², their mean being p.
  const double n = all_.rows, sum = event.sum + p * all_.u;
  return std::max(0.0, event.squares + p * p * all_.uu - sum * sum / n) / (d * d) * n /
         std::max(1.0, n - 1.0);
}

double WeightedMean::probability() const noexcept {
  if (!(all_.known > 0.0)) return no_value;
  const Event event = rarer();
  return event.is_one ? event.estimate : 1.0 - event.estimate;
}

Interval WeightedMean::probability_interval(double confidence) const {
  if (!(all_.w > 0.0)) return {0.0, 1.0};
  const Event event = rarer();
  // None of as many independent rows: what is said of an event that is not reached.
  const double none = 1.0 - std::pow(0.5 * (1.0 - confidence), 1.0 / std::max(1.0, effective()));
  Interval interval{0.0, none};
  if (event.rows > 0.0) {
    double variance = variance_of(event);
    if (clusters_.kind == Clusters::Kind::replicates) {
      const double widened =
          student(confidence, std::max(1.0, static_cast<double>(clusters_.size) - 1.0)) /
          two_sided(confidence);
      variance *= widened * widened;
    }
    // Rows of a weight may happen to be alike: never less than a count of them scatters.
    const double largest = event.largest / event.divisor;
    variance = std::max(variance, 1e-6 * event.estimate * event.estimate);
    interval = gamma_interval(event.estimate, variance, largest, confidence);
    // Of a few rows nobody knows how large others' weights may be.
    if (event.sum * event.sum < enough_rows * event.squares)
      interval.high = std::max(interval.high, none);
  }
  interval.high = std::min(1.0, interval.high);
  return event.is_one ? interval : Interval{1.0 - interval.high, 1.0 - interval.low};
}

double WeightedMean::rows_of_event() const noexcept { return rarer().rows; }

double WeightedMean::effective_of_event() const noexcept {
  const Event event = rarer();
  return event.squares > 0.0 ? event.sum * event.sum / event.squares : 0.0;
}

double WeightedMean::largest_share() const noexcept {
  const Event event = rarer();
  return event.sum > 0.0 ? event.largest / event.sum : no_value;
}

}  // namespace asdic::detail::study
