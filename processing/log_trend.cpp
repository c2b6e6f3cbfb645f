#include "processing/log_trend.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace asdic::detail {
namespace {

/// h(b) = −b Σt − m ln(S(b) + x) and its slope and bend; concave, since ln S is convex.
struct Exponent {
  std::span<const double> logs, times;  // ln z_j; t_j
  double log_x = 0.0;                   // −∞: without x
  double sum = 0.0;                     // Σt

  struct At {
    double value = 0.0, slope = 0.0, bend = 0.0;
  };
  [[nodiscard]] At operator()(double b) const {
    const auto m = static_cast<double>(times.size());
    double most = log_x;
    for (std::size_t j = 0; j < times.size(); ++j) most = std::max(most, logs[j] - b * times[j]);
    double total = std::exp(log_x - most), first = 0.0, second = 0.0;
    for (std::size_t j = 0; j < times.size(); ++j) {
      const double w = std::exp(logs[j] - b * times[j] - most);
      total += w;
      first += w * times[j];
      second += w * times[j] * times[j];
    }
    const double mean = first / total;
    return {.value = -b * sum - m * (most + std::log(total)),
            .slope = m * mean - sum,
            .bend = -m * (second / total - mean * mean)};
  }
};

/// ln ∫ e^h(b) db, by equal steps: h is concave and smooth, so that the sum of them is exact to
/// many digits; what lies 40 below its top is left out.
double log_integral(const Exponent& h) {
  // The top lies between slopes of different signs: doubling, then Newton's steps within.
  double low = -1.0, high = 1.0;
  for (int i = 0; i < 200 && h(low).slope < 0.0; ++i) low *= 2.0;
  for (int i = 0; i < 200 && h(high).slope > 0.0; ++i) high *= 2.0;
  double b = 0.5 * (low + high);
  Exponent::At top = h(b);
  for (int i = 0; i < 100; ++i) {
    (top.slope > 0.0 ? low : high) = b;
    double next = b - top.slope / top.bend;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - b);
    b = next;
    top = h(b);
    if (moved < 1e-9 * (1.0 + std::abs(b))) break;
  }
  constexpr double faint = 40.0;
  const double step = 0.25 / std::sqrt(-top.bend);
  double sum = 1.0;
  for (const double way : {-step, step})
    for (int k = 1; k < 20000; ++k) {
      const double below = h(b + k * way).value - top.value;
      if (below < -faint) break;
      sum += std::exp(below);
    }
  return top.value + std::log(sum * step);
}

}  // namespace

double log_exceedance_over_trend(std::span<const double> powers, std::span<const double> times,
                                 double x) {
  // In units in which the times scatter by 1.
  const auto m = static_cast<double>(times.size());
  double mean = 0.0, square = 0.0;
  for (const double t : times) mean += t / m;
  for (const double t : times) square += (t - mean) * (t - mean) / m;
  const double unit = std::sqrt(square);
  std::vector<double> logs, scaled;
  for (std::size_t j = 0; j < times.size(); ++j) {
    logs.push_back(std::log(powers[j]));
    scaled.push_back(times[j] / unit);
  }
  Exponent h{.logs = logs, .times = scaled, .log_x = std::log(x), .sum = m * mean / unit};
  const double with = log_integral(h);
  h.log_x = -INFINITY;
  return std::min(0.0, with - log_integral(h));
}

}  // namespace asdic::detail
