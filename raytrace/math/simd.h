#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <experimental/simd>
#include <utility>

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

namespace asdic::detail {
inline namespace ASDIC_LEVEL {

/// As many single-precision numbers as the machine adds at once, but eight at most. A beam reaches
/// some tens of rows: of sixteen lanes more are left empty at its end, and a square of sixteen rows
/// takes four times the shuffles (fields of Gaussians were a fifth dearer, of hats a fifteenth).
inline constexpr std::size_t simd_width =
    std::min<std::size_t>(8, std::experimental::native_simd<float>::size());
using SimdFloats =
    std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, simd_width>>;

inline SimdFloats load(const float* from) noexcept {
  return SimdFloats(from, std::experimental::element_aligned);
}
inline void store(const SimdFloats& value, float* to) noexcept {
  value.copy_to(to, std::experimental::element_aligned);
}

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

/// As many whole numbers.
using SimdInts = std::experimental::rebind_simd_t<std::int32_t, SimdFloats>;

inline SimdInts load(const std::int32_t* from) noexcept {
  return SimdInts(from, std::experimental::element_aligned);
}
inline SimdFloats to_floats(const SimdInts& numbers) noexcept {
  return std::experimental::static_simd_cast<SimdFloats>(numbers);
}

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
    using Eight [[gnu::vector_size(32)]] = float;
    Eight r[8], t[8];
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

/// cos and sin of an angle of up to some 10⁴ rad, to 2e-7, out of those of half of it within ±π/2.
inline void cos_sin(const SimdFloats& angle, SimdFloats& cosine, SimdFloats& sine) noexcept {
  constexpr float per_cycle = static_cast<float>(0.5 / pi);
  constexpr float cycle_high = 6.28125F, cycle_low = static_cast<float>(2.0 * pi - 6.28125);
  const SimdFloats cycles = nearest(angle * per_cycle);
  const SimdFloats x = 0.5F * ((angle - cycles * cycle_high) - cycles * cycle_low);
  const SimdFloats x2 = x * x;
  const SimdFloats s =
      x * (1.0F + x2 * (-1.0F / 6 +
                        x2 * (1.0F / 120 + x2 * (-1.0F / 5040 +
                                                 x2 * (1.0F / 362880 + x2 * (-1.0F / 39916800))))));
  const SimdFloats c =
      1.0F +
      x2 * (-0.5F + x2 * (1.0F / 24 + x2 * (-1.0F / 720 +
                                            x2 * (1.0F / 40320 + x2 * (-1.0F / 3628800 +
                                                                       x2 * (1.0F / 479001600))))));
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

}  // namespace ASDIC_LEVEL
}  // namespace asdic::detail
