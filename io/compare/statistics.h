#pragma once
#include <cstddef>
#include <vector>

namespace asdic::detail::compare {

/// How large differences are: of their magnitudes but for the mean.
struct Spread {
  std::size_t count = 0;
  double mean = 0.0;                                                ///< of the signed differences
  double median = 0.0, p90 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;  ///< of |difference|
};

/// \param differences  signed, finite; none: all zero
[[nodiscard]] Spread spread_of(std::vector<double> differences);

/// 100·part/all; 100 of nothing. [%]
[[nodiscard]] double share_pct(std::size_t part, std::size_t all) noexcept;

/// The value below which a share of a sorted list lies, straight lines between its members (the
/// usual definition of numpy and of R's type 7). \param sorted  not empty   \param share  0..1
[[nodiscard]] double quantile(const std::vector<double>& sorted, double share);

}  // namespace asdic::detail::compare
