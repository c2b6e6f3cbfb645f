#include "processing/normaliser.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check_settings.h"

namespace asdic::detail {
namespace {

constexpr double outstanding = 4.0;  // over the last mean: put back to it
/// A mean that was itself clipped by a low mean is lower still, so its lower tail, which lets false
/// alarms through, is that of fewer cells. Measured: 6·10⁷ exponential cells, windows of 6 to 24
/// cells a side, P = 10⁻³ … 10⁻⁵ (docs/theory/processing.md).
constexpr double cells_of_clipped = 0.91;

}  // namespace

namespace {

/// Probability that a mean of `looks` exponential values is over α times the mean of so many cells
/// of the same kind: with x = α/M, P = Σ_{k<N} Γ(NM + k)/(Γ(NM) k!) x^k (1 + x)^−(NM + k); of very
/// many cells e^{−Nα} Σ (Nα)^k/k!. \return ln P
double log_exceedance(double alpha, double cells, int looks) {
  const bool known = cells > 1e6;
  const double n = looks, m = n * cells;
  double sum = 0.0;
  for (int k = 0; k < looks; ++k) {
    const double x = known ? n * alpha : alpha / cells;
    const double ways = known ? 0.0 : std::lgamma(m + k) - std::lgamma(m) - k * std::log1p(x);
    sum += std::exp(ways - std::lgamma(k + 1.0) + k * std::log(x));
  }
  return std::log(sum) - (known ? n * alpha : m * std::log1p(alpha / cells));
}

/// What exponential values' means have on average once those above r times theirs are put back to
/// it: 1 − ∫_r (x − 1) p(x) dx, 1 − r·e^(−r) of one value.
double mean_of_clipped(int looks) {
  if (looks == 1) return 1.0 - outstanding * std::exp(-outstanding);
  // ∫_r x p dx − ∫_r p dx = Q(N + 1, Nr) − Q(N, Nr), the last term of a Poisson sum.
  const double x = looks * outstanding;
  return 1.0 - std::exp(looks * std::log(x) - x - std::lgamma(looks + 1.0));
}

}  // namespace

double cfar_multiplier(double false_alarm_probability, double cells, int looks) {
  if (looks > 1) {
    const double wanted = std::log(false_alarm_probability);
    double low = 1e-3, high = 2.0;
    while (log_exceedance(high, cells, looks) > wanted && high < 1e12) high *= 2.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (log_exceedance(middle, cells, looks) > wanted ? low : high) = middle;
    }
    return high;
  }
  if (cells > 1e6) return -std::log(false_alarm_probability);
  return cells * std::expm1(-std::log(false_alarm_probability) / cells);
}

BackgroundEstimator::BackgroundEstimator(const NormaliserSettings& settings, double cell,
                                         double guard, int looks)
    : settings_(settings), put_back_(mean_of_clipped(looks)) {
  check_settings(settings);
  guard_ = static_cast<std::size_t>(std::ceil(std::max(settings.guard_cells * cell, guard)));
  reference_ = static_cast<std::size_t>(std::max(1.0, std::round(settings.reference_cells * cell)));
  multiplier_.push_back(std::numeric_limits<float>::infinity());
  const double worth = settings.method == Normaliser::split_window ? cells_of_clipped : 1.0;
  for (std::size_t count = 1; count <= 2 * reference_; ++count)
    multiplier_.push_back(static_cast<float>(cfar_multiplier(
        settings.false_alarm_probability, worth * static_cast<double>(count) / cell, looks)));
}

void BackgroundEstimator::operator()(std::span<const float> power, std::span<float> background,
                                     std::span<float> threshold, Scratch& scratch) const {
  const std::size_t n = power.size();
  scratch.sums.resize(n + 1);
  const auto average = [&](std::span<const float> values, double correction) {
    scratch.sums[0] = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      scratch.sums[i + 1] = scratch.sums[i] + static_cast<double>(values[i]);
    const auto at_edge = [&](std::size_t i) {
      const std::size_t left_end = i > guard_ ? i - guard_ : 0;
      const std::size_t left = left_end > reference_ ? left_end - reference_ : 0;
      const std::size_t right = std::min(i + 1 + guard_, n);
      const std::size_t right_end = std::min(right + reference_, n);
      const std::size_t count = (left_end - left) + (right_end - right);
      const double sum = (scratch.sums[left_end] - scratch.sums[left]) +
                         (scratch.sums[right_end] - scratch.sums[right]);
      background[i] = count == 0
                          ? std::numeric_limits<float>::infinity()
                          : static_cast<float>(correction * sum / static_cast<double>(count));
      threshold[i] = multiplier_[count] * background[i];
    };
    const std::size_t wing = guard_ + reference_;  // inside, both windows are whole
    const std::size_t begin = std::min(wing, n),
                      end = n > wing + 1 ? std::max(begin, n - wing) : begin;
    for (std::size_t i = 0; i < begin; ++i) at_edge(i);
    const double share = correction / static_cast<double>(2 * reference_);
    const float multiplier = multiplier_[2 * reference_];
    const double* const sums = scratch.sums.data();
    for (std::size_t i = begin; i < end; ++i) {
      const double sum =
          (sums[i - guard_] - sums[i - wing]) + (sums[i + 1 + wing] - sums[i + 1 + guard_]);
      background[i] = static_cast<float>(share * sum);
      threshold[i] = multiplier * background[i];
    }
    for (std::size_t i = end; i < n; ++i) at_edge(i);
  };
  average(power, 1.0);
  if (settings_.method == Normaliser::cell_averaging) return;
  // Exponential values above r·µ replaced by µ have the mean µ·(1 − r·e^(−r)). Once more, for a
  // very loud echo lifts the first mean so far that its own flanks hide.
  scratch.clipped.resize(n);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < n; ++i)
      scratch.clipped[i] =
          power[i] > static_cast<float>(outstanding) * background[i] ? background[i] : power[i];
    average(scratch.clipped, 1.0 / put_back_);
  }
}

}  // namespace asdic::detail
