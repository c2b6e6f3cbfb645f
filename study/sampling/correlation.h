#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace asdic::detail::study {

/// A Gaussian copula: inputs whose normal scores Φ⁻¹(F(x)) have a correlation matrix, each with its
/// own law. docs/theory/designs.md
class Copula {
 public:
  /// The entry at which a matrix stops being one of correlations, and between what it may lie.
  struct Fault {
    std::size_t row = 0, column = 0;
    double low = 0.0, high = 0.0;
  };
  /// Independent inputs.
  Copula() = default;
  /// \param matrix  [inputs][inputs] symmetric, with ones on its diagonal
  explicit Copula(const std::vector<std::vector<double>>& matrix);

  /// Where it is not positive definite, as far as the entries before it (row by row, below the
  /// diagonal) go; none: it is.
  [[nodiscard]] const std::optional<Fault>& fault() const noexcept { return fault_; }
  /// Independent uniform numbers become dependent ones. The first one stays what it is, to the bit.
  /// \param u  [inputs] each in (0, 1)
  void apply(std::span<double> u) const noexcept;

 private:
  std::vector<std::vector<double>> lower_;  // Cholesky's, [inputs][row + 1]
  std::optional<Fault> fault_;
};

/// The correlation of normal scores that gives a rank correlation (Spearman's ρ):
/// r = 2 sin(πρ/6). Pearson 1907; Kruskal, JASA 53, 814 (1958)
[[nodiscard]] double scores_of_ranks(double rank_correlation) noexcept;

}  // namespace asdic::detail::study
