#include "study/summary/k_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "study/summary/intervals.h"

namespace asdic::detail::study {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();
constexpr double least_shape = 0.05, most_shape = 1e4;

}  // namespace

double k_exceedance(double u, double shape, double cells) {
  if (u <= 0.0) return 1.0;
  const double t = std::isinf(cells) ? u : cells * std::expm1(u / cells);
  const double v = std::isinf(cells) ? 0.0 : (1.0 + 2.0 / shape) / cells;
  // Over s = ln τ from where either factor is nothing; the integrand is smooth.
  const double wide = 9.0 / std::sqrt(shape) + 30.0 / shape;
  const double low = std::max(-wide, std::log(t) - 4.0 - 30.0 * v);
  const double high = std::log1p((45.0 + 9.0 * std::sqrt(shape)) / shape);
  constexpr int steps = 100;
  const double step = (high - low) / steps, scale = shape * std::log(shape) - std::lgamma(shape);
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double s = low + i * step, x = t * std::exp(-s);
    const double over = v > 0.0 ? -std::log1p(v * x) / v : -x;
    sum += std::exp(over + scale + shape * (s - std::exp(s))) * (i == 0 || i == steps ? 0.5 : 1.0);
  }
  return std::min(1.0, sum * step);
}

ShapeFit fit_k_shape(std::span<const double> levels, std::span<const double> counts, double cells,
                     double dispersion, double confidence) {
  const double none = std::nan("");
  std::size_t end = counts.size();
  while (end > 0 && counts[end - 1] <= 0.0) --end;
  if (end == 0) return {none, none, none};
  const auto likelihood = [&](double log_shape) {
    const double shape = std::exp(log_shape);
    const bool rayleigh = shape > 0.999 * most_shape;
    const auto above = [&](double u) {
      return rayleigh ? std::exp(-u) : k_exceedance(u, shape, cells);
    };
    double sum = 0.0, from = 1.0;
    for (std::size_t i = 0; i < end; ++i) {
      const double to = i + 1 < levels.size() ? above(levels[i + 1]) : 0.0;
      if (counts[i] > 0.0) sum += counts[i] * std::log(std::max(from - to, 1e-300));
      from = to;
    }
    return sum;
  };
  const double low = std::log(least_shape), high = std::log(most_shape);
  constexpr int grid = 16;
  double best = low, top = -no_end;
  for (int i = 0; i <= grid; ++i) {
    const double x = std::lerp(low, high, static_cast<double>(i) / grid);
    if (const double l = likelihood(x); l > top) {
      top = l;
      best = x;
    }
  }
  const double step = (high - low) / grid;
  double a = std::max(low, best - step), b = std::min(high, best + step);
  constexpr double golden = 0.6180339887498949;
  for (int i = 0; i < 12; ++i) {
    const double c = b - golden * (b - a), d = a + golden * (b - a);
    if (likelihood(c) < likelihood(d))
      a = c;
    else
      b = d;
  }
  const double middle = 0.5 * (a + b);
  if (const double l = likelihood(middle); l > top) {
    top = l;
    best = middle;
  }
  const double z = two_sided(confidence), least = top - 0.5 * z * z * std::max(1.0, dispersion);
  const auto edge = [&](double inside, double outside) {
    if (likelihood(outside) >= least) return outside;
    for (int i = 0; i < 14; ++i) {
      const double half = 0.5 * (inside + outside);
      (likelihood(half) >= least ? inside : outside) = half;
    }
    return inside;
  };
  const double most = edge(best, high);
  const auto told = [&](double x) { return x > high - 1e-3 ? no_end : std::exp(x); };
  return {told(best), std::exp(edge(best, low)), told(most)};
}

}  // namespace asdic::detail::study
