#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "core/level_namespace.h"
#include "core/simd.h"
#include "core/units.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// A extent of σ as x from −1 to 1.
struct SigmaExtent {
  double middle, per_half;

  SigmaExtent(double low, double high) noexcept
      : middle(0.5 * (low + high)), per_half(2.0 / (high - low)) {}
  [[nodiscard]] double high() const noexcept { return middle + 1.0 / per_half; }
  [[nodiscard]] SimdDoubles x(const SimdDoubles& sigma) const noexcept {
    return (sigma - middle) * per_half;
  }
};

/// Functions side by side as polynomials in x, −1 ≤ x ≤ 1, from their values at Chebyshev's points.
/// Terms that fall as 4^(−n), as those of a good series do, make coefficients that do not grow
/// (2^(n − 1) each), so that Horner's rule may evaluate them.
template <std::size_t functions>
struct PolynomialFit {
  static constexpr std::size_t terms = 16;

  /// [terms][functions] of xʲ; before `fit` [functions][terms], the values at `point` j.
  std::array<double, terms * functions> numbers;
  std::array<double, functions> size{};  ///< of each, the sum of all its terms' magnitudes
  std::array<double, functions> tail{};  ///< the last two terms together: what is not told

  /// cos(π(j + ½)/n), j < n.
  [[nodiscard]] static double point(std::size_t j) noexcept { return cosines()[1][j]; }

  /// Values into coefficients: c_k = (2/n)·Σ_j f_j·cos(πk(j + ½)/n) (half of that for k = 0), then
  /// Σ c_k·T_k(x) as Σ a_j·xʲ. Points lie in pairs ±x: even terms know their sums, odd ones their
  /// differences.
  void fit() noexcept {
    constexpr std::size_t half = terms / 2;
    const Table &cosine = cosines(), &power = chebyshev();
    std::array<std::array<double, functions>, half> sum, difference;
    for (std::size_t j = 0; j < half; ++j)
      for (std::size_t f = 0; f < functions; ++f) {
        const double *const value = &numbers[f * terms], one = value[j],
                            other = value[terms - 1 - j];
        sum[j][f] = one + other;
        difference[j][f] = one - other;
      }
    numbers = {};
    size = tail = {};
    for (std::size_t k = terms; k-- > 0;) {  // small terms first
      std::array<double, functions> c{};
      const auto& parity = k % 2 == 0 ? sum : difference;
      for (std::size_t j = 0; j < half; ++j) {
        const double weight = (k == 0 ? 1.0 : 2.0) / double(terms) * cosine[k][j];
        for (std::size_t f = 0; f < functions; ++f) c[f] += weight * parity[j][f];
      }
      if (k + 2 >= terms)
        for (std::size_t f = 0; f < functions; ++f) tail[f] += std::abs(c[f]);
      for (std::size_t f = 0; f < functions; ++f) size[f] += std::abs(c[f]);
      for (std::size_t j = k % 2; j <= k; j += 2) {
        const double of_power = power[k][j];
        for (std::size_t f = 0; f < functions; ++f) numbers[j * functions + f] += of_power * c[f];
      }
    }
  }

 private:
  using Table = std::array<std::array<double, terms>, terms>;
  /// [k][j] cos(πk(j + ½)/n)
  static const Table& cosines() noexcept {
    static const Table table = [] {
      Table t{};
      for (std::size_t k = 0; k < terms; ++k)
        for (std::size_t j = 0; j < terms; ++j)
          t[k][j] = std::cos(pi * double(k) * (double(j) + 0.5) / double(terms));
      return t;
    }();
    return table;
  }
  /// [k][j] of xʲ in T_k, T_{k+1} = 2x·T_k − T_{k−1}
  static const Table& chebyshev() noexcept {
    static const Table table = [] {
      Table t{};
      t[0][0] = t[1][1] = 1.0;
      for (std::size_t k = 2; k < terms; ++k)
        for (std::size_t j = 0; j <= k; ++j)
          t[k][j] = (j > 0 ? 2.0 * t[k - 1][j - 1] : 0.0) - t[k - 2][j];
      return t;
    }();
    return table;
  }
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
