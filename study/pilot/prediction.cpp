#include "study/pilot/prediction.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/units.h"
#include "study/summary/clustered_mean.h"

namespace asdic::detail::study {
namespace {

/// Returns an upper bound, or NaN where it is beyond what the rows support (most_supported).
double supported(double high, double estimate) {
  return high <= most_supported * estimate ? high : std::nan("");
}

}  // namespace

Predicted predicted_total(std::span<const double> groups, std::uint64_t rows, std::uint64_t count,
                          double confidence) {
  Moments of, logs;
  for (const double x : groups) {
    of.add(x);
    logs.add(std::log(std::max(x, 1e-12)));
  }
  const double n = of.count(), size = static_cast<double>(rows);
  const double all = static_cast<double>(count) / size, rest = std::max(0.0, all - n);
  const double known = size * n * of.mean();
  Predicted made{.total = known + size * rest * of.mean(), .interval = {}};
  if (n < 2.0) {
    made.interval = {std::nan(""), std::nan("")};
    return made;
  }
  if (!(rest > 0.0)) {
    made.interval = {made.total, made.total};
    return made;
  }
  const double t = student(confidence, n - 1.0), spread = 1.0 / n + 1.0 / rest;
  const double half = t * of.deviation() * std::sqrt(spread);
  const double v = logs.deviation() * logs.deviation();
  const double middle = logs.mean() + 0.5 * v;
  const double wide = t * std::sqrt(v * spread + 0.5 * v * v / (n - 1.0));
  const double low = std::min(of.mean() - half, std::exp(middle - wide));
  const double high = supported(std::max(of.mean() + half, std::exp(middle + wide)), of.mean());
  made.interval = {known + size * rest * std::max(0.0, low), known + size * rest * high};
  return made;
}

Predicted predicted_greatest(std::span<const double> known, std::uint64_t count, double confidence,
                             double least) {
  Moments logs;
  double most = 0.0;
  for (const double x : known) {
    logs.add(std::log(std::max(x, least)));
    most = std::max(most, x);
  }
  const double m = logs.count(), n = static_cast<double>(count);
  if (!(n > m)) return {.total = most, .interval = {most, most}};
  if (m < 2.0) return {.total = most, .interval = {most, std::nan("")}};
  const double over = -std::expm1(std::log(0.5) / n);  // P(a value > the median of the greatest)
  const double z = two_sided(1.0 - 2.0 * over);
  const double wide = student(confidence, m - 1.0) * logs.deviation() *
                      std::sqrt(1.0 / m + z * z / (2.0 * (m - 1.0)) + pi * pi / (6.0 * z * z));
  const double middle = logs.mean() + z * logs.deviation();
  const auto at_least = [&](double log) { return std::max(most, std::exp(log)); };
  const double total = at_least(middle);
  if (!(total <= most_supported * std::max(most, least)))
    return {.total = most, .interval = {most, std::nan("")}};
  return {.total = total,
          .interval = {at_least(middle - wide), supported(at_least(middle + wide), total)}};
}

std::vector<std::uint64_t> rows_to_try(std::uint64_t count, std::uint64_t groups,
                                       std::uint64_t rows) {
  const std::uint64_t all = count / rows, tried = std::min(groups, all);
  std::vector<std::uint64_t> indices;
  if (tried == 0) {
    for (std::uint64_t index = 0; index < count; ++index) indices.push_back(index);
    return indices;
  }
  std::mt19937_64 random(20261127);  // any number: the same rows each time
  for (std::uint64_t k = 0; k < tried; ++k) {
    // k·all/tried without leaving 64 bits
    const auto cut = [&](std::uint64_t i) { return all / tried * i + all % tried * i / tried; };
    const std::uint64_t group = cut(k) + random() % (cut(k + 1) - cut(k));
    for (std::uint64_t row = 0; row < rows; ++row) indices.push_back(group * rows + row);
  }
  return indices;
}

}  // namespace asdic::detail::study
