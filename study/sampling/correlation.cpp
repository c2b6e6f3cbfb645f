#include "study/sampling/correlation.h"

#include <cmath>

#include "core/units.h"
#include "study/sampling/law.h"

namespace asdic::detail::study {

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
    for (std::size_t j = 0; j <= i; ++j) z += lower_[i][j] * normal_score(u[j]);
    u[i] = normal_share(z);
  }
}

double scores_of_ranks(double rank_correlation) noexcept {
  return 2.0 * std::sin(pi * rank_correlation / 6.0);
}

}  // namespace asdic::detail::study
