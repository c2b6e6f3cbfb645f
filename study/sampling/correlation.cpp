#include "study/sampling/correlation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "study/sampling/law.h"

namespace asdic::detail::study {
namespace {

/// Φ⁻¹ by the smaller tail.
double score(double u) noexcept {
  return u < 0.5 ? -normal_upper_quantile(u) : normal_upper_quantile(1.0 - u);
}

/// Φ, never 0 or 1.
double share(double score) noexcept {
  return std::clamp(0.5 * std::erfc(-score / std::numbers::sqrt2), 0x1p-54, 1.0 - 0x1p-53);
}

}  // namespace

Copula::Copula(const std::vector<std::vector<double>>& matrix) {
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    std::vector<double> row;
    double rest = 1.0;  // of the variance of input i, that those before it leave to it
    for (std::size_t j = 0; j < i; ++j) {
      double known = 0.0;
      for (std::size_t m = 0; m < j; ++m) known += row[m] * lower_[j][m];
      const double x = (matrix[i][j] - known) / lower_[j][j];
      if (!(x * x < rest * (1.0 - 1e-12))) {
        const double reach = lower_[j][j] * std::sqrt(rest);
        fault_ = {.row = i, .column = j, .low = known - reach, .high = known + reach};
        return;
      }
      row.push_back(x);
      rest -= x * x;
    }
    row.push_back(std::sqrt(rest));
    lower_.push_back(std::move(row));
  }
}

void Copula::apply(std::span<double> u) const noexcept {
  // From the last one: those before it are still independent.
  for (std::size_t i = lower_.size(); i-- > 1;) {
    double z = 0.0;
    for (std::size_t j = 0; j <= i; ++j) z += lower_[i][j] * score(u[j]);
    u[i] = share(z);
  }
}

double scores_of_ranks(double rank_correlation) noexcept {
  return 2.0 * std::sin(pi * rank_correlation / 6.0);
}

}  // namespace asdic::detail::study
