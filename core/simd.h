#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <experimental/simd>
#include <utility>

#include "core/arc_series.h"
#include "core/level_namespace.h"
#include "core/units.h"
#if defined(__AVX2__)
#include <immintrin.h>
#endif

/// The compiler may take the next loop's iterations for independent.
#if defined(__clang__)
#define ASDIC_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define ASDIC_INDEPENDENT _Pragma("GCC ivdep")
#endif

/// Numbers in lanes: types, loads and stores, shuffles, selects and elementary functions of them.
///
/// Two families. SimdFloats, SimdInts and SimdDoubles are as wide as the machine adds at once:
/// comparisons make masks, `where(mask, x) = y` selects. Lanes<T, n> has n numbers on every
/// machine, in an order that shuffles may change. The plain form of each function is beside it in
/// tests/core/unit/simd.cpp.
namespace asdic::detail {
inline namespace ASDIC_LEVEL {

// Types.

/// As many single-precision numbers as the machine adds at once, but eight at most. A beam reaches
/// some tens of rows: of sixteen lanes more are left empty at its end, and a square of sixteen rows
/// takes four times the shuffles (fields of Gaussians were a fifth dearer, of hats a fifteenth).
inline constexpr std::size_t simd_width =
    std::min<std::size_t>(8, std::experimental::native_simd<float>::size());
using SimdFloats =
    std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, simd_width>>;
using SimdInts = std::experimental::rebind_simd_t<std::int32_t, SimdFloats>;

/// As many double-precision numbers as the machine adds at once.
using SimdDoubles = std::experimental::native_simd<double>;
using SimdBits = std::experimental::rebind_simd_t<std::uint64_t, SimdDoubles>;
inline constexpr std::size_t doubles_at_once = SimdDoubles::size();

/// As many single-precision numbers, where more than eight are worth while, and as many integers.
using WideFloats = std::experimental::native_simd<float>;
using WideInts = std::experimental::rebind_simd_t<std::int32_t, WideFloats>;

template <class T, std::size_t n>
struct LanesOf {
  using type [[gnu::vector_size(n * sizeof(T))]] = T;
};
/// n numbers, whatever the machine adds at once; __builtin_shufflevector puts them in order.
template <class T, std::size_t n>
using Lanes = typename LanesOf<T, n>::type;

// Loads and stores, of any alignment.

[[nodiscard]] inline SimdFloats load(const float* from) noexcept {
  return SimdFloats(from, std::experimental::element_aligned);
}
inline void store(const SimdFloats& value, float* to) noexcept {
  value.copy_to(to, std::experimental::element_aligned);
}
[[nodiscard]] inline SimdInts load(const std::int32_t* from) noexcept {
  return SimdInts(from, std::experimental::element_aligned);
}
inline void store(const SimdInts& value, std::int32_t* to) noexcept {
  value.copy_to(to, std::experimental::element_aligned);
}
[[nodiscard]] inline SimdDoubles load(const double* from) noexcept {
  return SimdDoubles(from, std::experimental::element_aligned);
}
inline void store(const SimdDoubles& value, double* to) noexcept {
  value.copy_to(to, std::experimental::element_aligned);
}
template <class Numbers, class T>
[[nodiscard, gnu::always_inline]] inline Numbers load_lanes(const T* from) noexcept {
  Numbers lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
template <class Numbers, class T>
[[gnu::always_inline]] inline void store_lanes(const Numbers& lanes, T* to) noexcept {
  std::memcpy(to, &lanes, sizeof lanes);
}
[[nodiscard]] inline SimdFloats to_floats(const SimdInts& numbers) noexcept {
  return std::experimental::static_simd_cast<SimdFloats>(numbers);
}

// Shuffles.

#if defined(__AVX2__) && !defined(__AVX512VL__)
/// For each set of eight lanes, its members in order.
inline constexpr auto packing_orders = [] {
  std::array<std::array<std::uint8_t, 8>, 256> orders{};
  for (unsigned bits = 0; bits < 256; ++bits)
    for (std::uint8_t l = 0, n = 0; l < 8; ++l)
      if ((bits >> l & 1U) != 0) orders[bits][n++] = l;
  return orders;
}();
#endif

/// Puts some of the lanes side by side: those that are `wanted`.
class Packing {
 public:
  explicit Packing(const SimdInts::mask_type& wanted) noexcept {
    std::uint32_t bits = 0;
    for (std::size_t l = 0; l < simd_width; ++l) bits |= (wanted[l] ? 1U : 0U) << l;
    count_ = static_cast<std::size_t>(std::popcount(bits));
#if defined(__AVX512VL__)
    wanted_ = static_cast<__mmask8>(bits);
#elif defined(__AVX2__)
    order_ = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(packing_orders[bits].data())));
#else
    for (std::size_t l = 0, n = 0; l < simd_width; ++l)
      if (wanted[l]) order_[n++] = l;
#endif
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

  /// The wanted ones of [lanes] numbers; what `to` gets behind them is without meaning.
  void pack(const float* from, float* to) const noexcept {
#if defined(__AVX512VL__)
    _mm256_storeu_ps(to, _mm256_maskz_compress_ps(wanted_, _mm256_loadu_ps(from)));
#elif defined(__AVX2__)
    _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(_mm256_loadu_ps(from), order_));
#else
    for (std::size_t n = 0; n < count_; ++n) to[n] = from[order_[n]];
#endif
  }
  void pack(const std::int32_t* from, std::int32_t* to) const noexcept {
#if defined(__AVX2__)
    const auto* source = reinterpret_cast<const __m256i*>(from);
    auto* target = reinterpret_cast<__m256i*>(to);
#endif
#if defined(__AVX512VL__)
    _mm256_storeu_si256(target, _mm256_maskz_compress_epi32(wanted_, _mm256_loadu_si256(source)));
#elif defined(__AVX2__)
    _mm256_storeu_si256(target, _mm256_permutevar8x32_epi32(_mm256_loadu_si256(source), order_));
#else
    for (std::size_t n = 0; n < count_; ++n) to[n] = from[order_[n]];
#endif
  }

 private:
  std::size_t count_ = 0;
#if defined(__AVX512VL__)
  __mmask8 wanted_;
#elif defined(__AVX2__)
  __m256i order_;
#else
  std::array<std::size_t, simd_width> order_{};
#endif
};

/// A square of [lanes × lanes] numbers, turned over its diagonal in place.
[[gnu::always_inline]] inline void transpose(float* square) noexcept {
  if constexpr (simd_width == 8) {
    Lanes<float, 8> r[8], t[8];
    std::memcpy(r, square, sizeof r);  // in one piece: GCC 12 keeps the rows in registers then
    for (int i = 0; i < 8; i += 2) {   // half by half, each shuffle one instruction
      t[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
      t[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; i += 4)
      for (int j = 0; j < 2; ++j) {
        const int at = i + 2 * j;
        r[at] = __builtin_shufflevector(t[i + j], t[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
        r[at + 1] = __builtin_shufflevector(t[i + j], t[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
      }
    for (int i = 0; i < 4; ++i) {
      t[i] = __builtin_shufflevector(r[i], r[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
      t[i + 4] = __builtin_shufflevector(r[i], r[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
    std::memcpy(square, t, sizeof t);
  } else {
    for (std::size_t i = 0; i < simd_width; ++i)
      for (std::size_t j = 0; j < i; ++j)
        std::swap(square[i * simd_width + j], square[j * simd_width + i]);
  }
}

/// Four rows of four numbers, turned over the diagonal.
[[gnu::always_inline]] inline void transpose(std::array<Lanes<double, 4>, 4>& x) noexcept {
  using Four = Lanes<double, 4>;
  const Four even = __builtin_shufflevector(x[0], x[1], 0, 4, 2, 6);
  const Four odd = __builtin_shufflevector(x[0], x[1], 1, 5, 3, 7);
  const Four later_even = __builtin_shufflevector(x[2], x[3], 0, 4, 2, 6);
  const Four later_odd = __builtin_shufflevector(x[2], x[3], 1, 5, 3, 7);
  x = {__builtin_shufflevector(even, later_even, 0, 1, 4, 5),
       __builtin_shufflevector(odd, later_odd, 0, 1, 4, 5),
       __builtin_shufflevector(even, later_even, 2, 3, 6, 7),
       __builtin_shufflevector(odd, later_odd, 2, 3, 6, 7)};
}

// Elementary functions of single precision.

/// 0, 1, 2, …
inline SimdFloats ramp() noexcept {
  return SimdFloats([](auto i) { return static_cast<float>(static_cast<int>(i)); });
}

/// `magnitude`, above 0, with the sign of another. (clang 14 cannot read the library's.)
inline SimdFloats with_sign(const SimdFloats& magnitude, const SimdFloats& sign) noexcept {
#if defined(__clang__)
  SimdFloats result = magnitude;
  where(sign < 0.0F, result) = -magnitude;
  return result;
#else
  return copysign(magnitude, sign);
#endif
}

/// Nearest whole number, |x| < 4e6: adding 1.5·2²³ leaves no room for the fraction.
inline SimdFloats nearest(const SimdFloats& x) noexcept {
  constexpr float magic = 12582912.0F;
  return (x + magic) - magic;
}

/// cos h and sin h of |h| ≤ π/2, to 5e-8 and 7e-9: polynomials through Chebyshev nodes.
template <class Floats>
inline void cos_sin_of_half(const Floats& h, Floats& cosine, Floats& sine) noexcept {
  const Floats y = h * h;
  sine =
      h * (0.999999996F +
           y * (-0.166666579F + y * (0.00833305017F + y * (-1.98090174e-4F + y * 2.60510764e-6F))));
  cosine = 0.999999953F +
           y * (-0.499999048F + y * (0.0416635732F + y * (-0.00138536295F + y * 2.31524167e-5F)));
}

/// cos and sin of an angle of up to some 10⁴ rad, to 1e-6, out of those of half of it within ±π/2.
inline void cos_sin(const SimdFloats& angle, SimdFloats& cosine, SimdFloats& sine) noexcept {
  constexpr float per_cycle = static_cast<float>(0.5 / pi);
  constexpr float cycle_high = 6.28125F, cycle_low = static_cast<float>(2.0 * pi - 6.28125);
  const SimdFloats cycles = nearest(angle * per_cycle);
  SimdFloats c, s;
  cos_sin_of_half(0.5F * ((angle - cycles * cycle_high) - cycles * cycle_low), c, s);
  sine = 2.0F * s * c;
  cosine = 1.0F - 2.0F * s * s;
}

/// eˣ for −80 ≤ x ≤ 80 (below: of −80), to 2e-7: 2ⁿ·e^f with |f| ≤ ½·ln 2.
inline SimdFloats exponential(const SimdFloats& argument) noexcept {
  constexpr float log2_e = 1.44269504F, ln2_high = 0.693359375F, ln2_low = -2.12194440e-4F;
  const SimdFloats x = max(argument, SimdFloats(-80.0F));
  const SimdFloats n = nearest(x * log2_e);
  const SimdFloats f = (x - n * ln2_high) - n * ln2_low;
  const SimdFloats e =
      1.0F + f * (1.0F + f * (0.5F + f * (1.0F / 6 +
                                          f * (1.0F / 24 + f * (1.0F / 120 + f * (1.0F / 720))))));
  const SimdInts bits = (std::experimental::static_simd_cast<SimdInts>(n) + 127) << 23;
  return e * __builtin_bit_cast(SimdFloats, bits);
}

/// ln x of positive x, to 2e-8: x = (1 + t)·2ⁿ with 1 + t within √½..√2, ln(1 + t) = t + t²·P(t).
inline WideFloats logarithm(const WideFloats& x) noexcept {
  const WideInts root_half = 0x3F3504F3;
  const WideInts bits = __builtin_bit_cast(WideInts, x) - root_half;
  const WideFloats n = std::experimental::static_simd_cast<WideFloats>(bits >> 23);
  const WideFloats t = __builtin_bit_cast(WideFloats, (bits & 0x007FFFFF) + root_half) - 1.0F;
  const WideFloats p =
      -0.499999971F +
      t * (0.333336706F +
           t * (-0.250011477F +
                t * (0.199720497F +
                     t * (-0.165884885F +
                          t * (0.148347868F + t * (-0.141596470F + t * 0.0878726549F))))));
  return t + t * t * p + 0.69314718F * n;
}

// Elementary functions of double precision, to a few roundings. The library's are called lane by
// lane.

/// 1/k!
inline constexpr std::array<double, 22> per_factorial = [] {
  std::array<double, 22> value{1.0};
  for (std::size_t k = 1; k < value.size(); ++k) value[k] = value[k - 1] / double(k);
  return value;
}();

/// eˣ for |x| < 700: 2ⁿ·e^f with |f| ≤ ½·ln 2, where 13 terms leave 4e-18.
inline SimdDoubles exponential(const SimdDoubles& x) noexcept {
  constexpr double log2_e = 1.4426950408889634, ln2_high = 0.693147180369123816490,
                   ln2_low = 1.90821492927058770002e-10;  // the first with 33 bits
  constexpr double magic = 6755399441055744.0;            // 1.5·2⁵²: its last bits hold n
  const SimdDoubles shifted = x * log2_e + magic, n = shifted - magic;
  const SimdDoubles f = (x - n * ln2_high) - n * ln2_low;
  // Σ fᵏ/k!, even and odd k apart: neither waits for the other's products.
  const SimdDoubles f2 = f * f;
  SimdDoubles even = per_factorial[12], odd = per_factorial[13];
  for (std::size_t k = 12; k > 0; k -= 2) {
    even = even * f2 + per_factorial[k - 2];
    odd = odd * f2 + per_factorial[k - 1];
  }
  const SimdDoubles e = even + f * odd;
  const SimdBits bits =
      __builtin_bit_cast(SimdBits, e) + (__builtin_bit_cast(SimdBits, shifted) << 52);
  return __builtin_bit_cast(SimdDoubles, bits);
}

/// cos x and sin x for |x| < 10⁶: of x − nπ within ±π/2, where the terms left out are 1e-18, with
/// the sign of (−1)ⁿ.
inline void cos_sin(const SimdDoubles& x, SimdDoubles& cosine, SimdDoubles& sine) noexcept {
  constexpr double pi_high = 3.14159265346825122834,
                   pi_middle = 1.21542010126079319532e-10,  // both with 33 bits
      pi_low = 4.04453249742233291160e-21;
  constexpr double magic = 6755399441055744.0;  // 1.5·2⁵²: its last bits hold n
  const SimdDoubles shifted = x * (1.0 / pi) + magic, n = shifted - magic;
  const SimdDoubles r = ((x - n * pi_high) - n * pi_middle) - n * pi_low, r2 = -r * r;
  SimdDoubles even = per_factorial[20], odd = per_factorial[21];
  for (std::size_t k = 20; k > 0; k -= 2) {
    even = even * r2 + per_factorial[k - 2];
    odd = odd * r2 + per_factorial[k - 1];
  }
  const SimdBits sign = __builtin_bit_cast(SimdBits, shifted) << 63;
  const auto signed_by_n = [&](const SimdDoubles& value) {
    return __builtin_bit_cast(SimdDoubles, __builtin_bit_cast(SimdBits, value) ^ sign);
  };
  cosine = signed_by_n(even);
  sine = signed_by_n(r * odd);
}

/// ln x of positive x: x = 2ⁿ·m with m within √½..√2, ln m = 2·atanh[(m − 1)/(m + 1)], where 11
/// terms leave 1e-18.
inline SimdDoubles logarithm(const SimdDoubles& x) noexcept {
  const SimdBits bits = __builtin_bit_cast(SimdBits, x);
  const SimdBits power = (bits >> 52) | SimdBits(std::uint64_t{0x4330000000000000});  // 2⁵² + n
  SimdDoubles n = __builtin_bit_cast(SimdDoubles, power) - (4503599627370496.0 + 1023.0);
  SimdDoubles m =
      __builtin_bit_cast(SimdDoubles, (bits & SimdBits(std::uint64_t{0x000FFFFFFFFFFFFF})) |
                                          SimdBits(std::uint64_t{0x3FF0000000000000}));
  const auto large = m > 1.4142135623730951;
  where(large, m) = 0.5 * m;
  where(large, n) += 1.0;
  const SimdDoubles s = (m - 1.0) / (m + 1.0), y = s * s;
  SimdDoubles sum = 1.0 / 21;
  for (int k = 19; k > 0; k -= 2) sum = 1.0 / k + y * sum;
  return n * 0.6931471805599453 + 2.0 * s * sum;
}

/// (atanh x)/x for |x| < 1.
[[gnu::always_inline]] inline SimdDoubles atanh_over(const SimdDoubles& x) noexcept {
  const SimdDoubles series = atanh_series(x);
  const auto small = abs(x) < short_series;
  if (all_of(small)) return series;
  SimdDoubles ratio = 0.5 * logarithm((1.0 + x) / (1.0 - x)) / x;
  where(small, ratio) = series;
  return ratio;
}

/// atan2(sine, cosine) of angles from 0 to π/2: the smaller over the larger, t ≤ 1, is brought
/// below tan π/8 by atan t = π/4 + atan((t − 1)/(t + 1)), where 22 terms of the series leave 3e-19.
inline SimdDoubles angle_of(const SimdDoubles& sine, const SimdDoubles& cosine) noexcept {
  constexpr double tan_eighth = 0.41421356237309503;
  const auto steep = sine > cosine;
  SimdDoubles t = min(sine, cosine) / max(sine, cosine);
  const auto large = t > tan_eighth;
  where(large, t) = (t - 1.0) / (t + 1.0);
  const SimdDoubles y = t * t, y2 = y * y;
  SimdDoubles even = 1.0 / 41, odd = -1.0 / 43;  // Σ (−y)^n/(2n + 1), even and odd n apart
  for (int n = 18; n >= 0; n -= 2) {
    even = even * y2 + 1.0 / (2 * n + 1);
    odd = odd * y2 - 1.0 / (2 * n + 3);
  }
  SimdDoubles angle = t * (even + y * odd);
  where(large, angle) += 0.25 * pi;
  where(steep, angle) = 0.5 * pi - angle;
  return angle;
}

/// (asin x)/x for |x| ≤ 1; beyond, which is rounding, that of 1.
inline SimdDoubles asin_over(const SimdDoubles& x) noexcept {
  const SimdDoubles series = asin_series(x);
  const SimdDoubles size = min(abs(x), SimdDoubles(1.0));
  const auto small = size < short_series;
  if (all_of(small)) return series;
  SimdDoubles ratio = angle_of(size, sqrt((1.0 - size) * (1.0 + size))) / size;
  where(small, ratio) = series;
  return ratio;
}

}  // namespace ASDIC_LEVEL
}  // namespace asdic::detail
