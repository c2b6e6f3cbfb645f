#pragma once
#include <complex>

namespace asdic::detail {

/// z^n: one factor after the other while they are few, by squares of more. \param n  ≥ 0
[[nodiscard]] inline std::complex<double> integer_power(std::complex<double> z, int n) noexcept {
  constexpr int few = 16;
  std::complex<double> product = 1.0;
  for (; n > few; n /= 2, z *= z)
    if (n % 2 == 1) product *= z;
  for (int i = 0; i < n; ++i) product *= z;
  return product;
}

}  // namespace asdic::detail
