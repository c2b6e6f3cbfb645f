#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>

#include "core/level_namespace.h"
#include "core/units.h"
#include "raytrace/math/arc_series.h"

namespace asdic::detail {
inline namespace ASDIC_LEVEL {

/// As many double-precision numbers as the machine adds at once: one for each of several rays.
using Rays = std::experimental::native_simd<double>;
inline constexpr std::size_t rays_at_once = Rays::size();

inline Rays load(const double* from) noexcept {
  return Rays(from, std::experimental::element_aligned);
}
inline void store(const Rays& value, double* to) noexcept {
  value.copy_to(to, std::experimental::element_aligned);
}

// Elementary functions of lanes, to a few roundings; tests/raytrace/unit/simd_math.cpp. The
// library's are called lane by lane.

using RayBits = std::experimental::rebind_simd_t<std::uint64_t, Rays>;

/// 1/k!
inline constexpr std::array<double, 14> per_factorial = [] {
  std::array<double, 14> value{1.0};
  for (std::size_t k = 1; k < value.size(); ++k) value[k] = value[k - 1] / double(k);
  return value;
}();

/// eˣ for |x| < 700: 2ⁿ·e^f with |f| ≤ ½·ln 2, where 13 terms leave 4e-18.
inline Rays exponential(const Rays& x) noexcept {
  constexpr double log2_e = 1.4426950408889634, ln2_high = 0.693147180369123816490,
                   ln2_low = 1.90821492927058770002e-10;  // the first with 33 bits
  constexpr double magic = 6755399441055744.0;            // 1.5·2⁵²: its last bits hold n
  const Rays shifted = x * log2_e + magic, n = shifted - magic;
  const Rays f = (x - n * ln2_high) - n * ln2_low;
  // Σ fᵏ/k!, even and odd k apart: neither waits for the other's products.
  const Rays f2 = f * f;
  Rays even = per_factorial[12], odd = per_factorial[13];
  for (std::size_t k = 12; k > 0; k -= 2) {
    even = even * f2 + per_factorial[k - 2];
    odd = odd * f2 + per_factorial[k - 1];
  }
  const Rays e = even + f * odd;
  const RayBits bits =
      __builtin_bit_cast(RayBits, e) + (__builtin_bit_cast(RayBits, shifted) << 52);
  return __builtin_bit_cast(Rays, bits);
}

/// ln x of positive x: x = 2ⁿ·m with m within √½..√2, ln m = 2·atanh[(m − 1)/(m + 1)], where 11
/// terms leave 1e-18.
inline Rays logarithm(const Rays& x) noexcept {
  const RayBits bits = __builtin_bit_cast(RayBits, x);
  const RayBits power = (bits >> 52) | RayBits(std::uint64_t{0x4330000000000000});  // 2⁵² + n
  Rays n = __builtin_bit_cast(Rays, power) - (4503599627370496.0 + 1023.0);
  Rays m = __builtin_bit_cast(Rays, (bits & RayBits(std::uint64_t{0x000FFFFFFFFFFFFF})) |
                                        RayBits(std::uint64_t{0x3FF0000000000000}));
  const auto large = m > 1.4142135623730951;
  where(large, m) = 0.5 * m;
  where(large, n) += 1.0;
  const Rays s = (m - 1.0) / (m + 1.0), y = s * s;
  Rays sum = 1.0 / 21;
  for (int k = 19; k > 0; k -= 2) sum = 1.0 / k + y * sum;
  return n * 0.6931471805599453 + 2.0 * s * sum;
}

/// (atanh x)/x for |x| < 1.
inline Rays atanh_over(const Rays& x) noexcept {
  const Rays series = atanh_series(x);
  const auto small = abs(x) < short_series;
  if (all_of(small)) return series;
  Rays ratio = 0.5 * logarithm((1.0 + x) / (1.0 - x)) / x;
  where(small, ratio) = series;
  return ratio;
}

/// atan2(sine, cosine) of angles from 0 to π/2: the smaller over the larger, t ≤ 1, is brought
/// below tan π/8 by atan t = π/4 + atan((t − 1)/(t + 1)), where 22 terms of the series leave 3e-19.
inline Rays angle_of(const Rays& sine, const Rays& cosine) noexcept {
  constexpr double tan_eighth = 0.41421356237309503;
  const auto steep = sine > cosine;
  Rays t = min(sine, cosine) / max(sine, cosine);
  const auto large = t > tan_eighth;
  where(large, t) = (t - 1.0) / (t + 1.0);
  const Rays y = t * t, y2 = y * y;
  Rays even = 1.0 / 41, odd = -1.0 / 43;  // Σ (−y)^n/(2n + 1), even and odd n apart
  for (int n = 18; n >= 0; n -= 2) {
    even = even * y2 + 1.0 / (2 * n + 1);
    odd = odd * y2 - 1.0 / (2 * n + 3);
  }
  Rays angle = t * (even + y * odd);
  where(large, angle) += 0.25 * pi;
  where(steep, angle) = 0.5 * pi - angle;
  return angle;
}

/// (asin x)/x for |x| ≤ 1; beyond, which is rounding, that of 1.
inline Rays asin_over(const Rays& x) noexcept {
  const Rays series = asin_series(x);
  const Rays size = min(abs(x), Rays(1.0));
  const auto small = size < short_series;
  if (all_of(small)) return series;
  Rays ratio = angle_of(size, sqrt((1.0 - size) * (1.0 + size))) / size;
  where(small, ratio) = series;
  return ratio;
}

}  // namespace ASDIC_LEVEL
}  // namespace asdic::detail
