#include "io/compare/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace asdic::detail::compare {

double share_pct(std::size_t part, std::size_t all) noexcept {
  return all == 0 ? 100.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

Spread spread_of(std::vector<double> differences) {
  if (differences.empty()) return {};
  Spread result{.count = differences.size()};
  result.mean = std::accumulate(differences.begin(), differences.end(), 0.0) /
                static_cast<double>(differences.size());
  for (double& d : differences) d = std::abs(d);
  std::sort(differences.begin(), differences.end());
  result.median = quantile(differences, 0.50);
  result.p90 = quantile(differences, 0.90);
  result.p95 = quantile(differences, 0.95);
  result.p99 = quantile(differences, 0.99);
  result.max = differences.back();
  return result;
}

}  // namespace asdic::detail::compare
