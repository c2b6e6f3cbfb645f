#pragma once
#include <array>
#include <cstddef>

namespace asdic::detail {

inline constexpr double least_eta = 10.0;  // |⅔q^{3/2}/q′| from which series for large ones serve
inline constexpr int airy_terms = 9;
inline constexpr int power_terms = 26;
inline constexpr double power_phase = 3.0;  // |√q|·step of a power series

/// Coefficients of Airy's functions and of their derivatives for large arguments, DLMF 9.7.2.
struct AirySeries {
  std::array<double, airy_terms> c{}, d{};
  constexpr AirySeries() {
    c[0] = d[0] = 1.0;
    for (int k = 1; k < airy_terms; ++k) {
      const double n = k;
      c[std::size_t(k)] =
          c[std::size_t(k - 1)] * (6 * n - 5) * (6 * n - 3) * (6 * n - 1) / (216 * n * (2 * n - 1));
      d[std::size_t(k)] = -c[std::size_t(k)] * (6 * n + 1) / (6 * n - 1);
    }
  }
};
inline constexpr AirySeries for_large;

}  // namespace asdic::detail
