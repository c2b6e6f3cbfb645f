#include "core/normal.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/simd.h"

namespace asdic::detail {
namespace {

constexpr std::size_t lanes = 16;         // Philox blocks side by side
constexpr std::size_t batch = 4 * lanes;  // normals they give
using Words = std::array<std::uint32_t, lanes>;

namespace stdx = std::experimental;
using Floats = WideFloats;
using Ints = WideInts;

constexpr std::uint32_t multiplier_0 = 0xD2511F53U, multiplier_1 = 0xCD9E8D57U;
constexpr std::uint32_t key_step_0 = 0x9E3779B9U, key_step_1 = 0xBB67AE85U;  // golden ratio, √3 − 1
constexpr int rounds = 10;

#if defined(__AVX2__)

/// Philox4x32-10 of the counters (first…first + lanes, c1, c2, c3): Salmon et al., SC'11. Tested
/// against Random123.
///
/// A word lies in the lower half of 64 bits: multiplication looks at no more, so what is left in
/// the upper half is never cleared, and no word is moved before the end.
inline void philox(std::uint32_t first, std::array<std::uint32_t, 3> rest,
                   std::array<std::uint32_t, 2> key, std::array<Words, 4>& x) noexcept {
  const auto all = [](std::uint32_t word) { return _mm256_set1_epi64x(std::int64_t{word}); };
  const __m256i m0 = all(multiplier_0), m1 = all(multiplier_1);
  constexpr std::size_t side_by_side = 2;  // vectors of four blocks: what the registers hold
  for (std::size_t at = 0; at < lanes; at += 4 * side_by_side) {
    __m256i c[4][side_by_side];
    for (std::size_t v = 0; v < side_by_side; ++v) {
      const auto block = static_cast<std::uint32_t>(first + at + 4 * v);
      // A counter wraps at 2³², as it does there.
      c[0][v] = _mm256_set_epi64x(std::int64_t{block + 3U}, std::int64_t{block + 2U},
                                  std::int64_t{block + 1U}, std::int64_t{block});
      for (std::size_t word = 1; word < 4; ++word) c[word][v] = all(rest[word - 1]);
    }
    std::array<std::uint32_t, 2> k = key;
    for (int round = 0; round < rounds; ++round) {
      const __m256i k0 = all(k[0]), k1 = all(k[1]);
      for (std::size_t v = 0; v < side_by_side; ++v) {
        const __m256i p0 = _mm256_mul_epu32(m0, c[0][v]), p1 = _mm256_mul_epu32(m1, c[2][v]);
        c[0][v] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p1, 32), c[1][v]), k0);
        c[1][v] = p1;
        c[2][v] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p0, 32), c[3][v]), k1);
        c[3][v] = p0;
      }
      k[0] += key_step_0;
      k[1] += key_step_1;
    }
    for (std::size_t word = 0; word < 4; ++word) {  // the lower halves of eight blocks, in order
      const __m256i mixed = _mm256_castps_si256(_mm256_shuffle_ps(
          _mm256_castsi256_ps(c[word][0]), _mm256_castsi256_ps(c[word][1]), 0x88));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(x[word].data() + at),
                          _mm256_permute4x64_epi64(mixed, 0xD8));
    }
  }
}

#else

/// The same, written over lanes so that it vectorises.
inline void philox(std::uint32_t first, std::array<std::uint32_t, 3> rest,
                   std::array<std::uint32_t, 2> key, std::array<Words, 4>& x) noexcept {
  for (std::uint32_t i = 0; i < lanes; ++i) {
    x[0][i] = first + i;
    x[1][i] = rest[0];
    x[2][i] = rest[1];
    x[3][i] = rest[2];
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint64_t p0 = std::uint64_t{multiplier_0} * x[0][i];
      const std::uint64_t p1 = std::uint64_t{multiplier_1} * x[2][i];
      const std::uint32_t x1 = x[1][i], x3 = x[3][i];
      x[0][i] = static_cast<std::uint32_t>(p1 >> 32) ^ x1 ^ key[0];
      x[1][i] = static_cast<std::uint32_t>(p1);
      x[2][i] = static_cast<std::uint32_t>(p0 >> 32) ^ x3 ^ key[1];
      x[3][i] = static_cast<std::uint32_t>(p0);
    }
    key[0] += key_step_0;
    key[1] += key_step_1;
  }
}

#endif

/// 64 normals out of the 16 blocks from `first`: words 0 and 2 give radii, 1 and 3 angles.
inline void normals(std::uint32_t first, std::array<std::uint32_t, 3> rest,
                    std::array<std::uint32_t, 2> key, float* __restrict out) noexcept {
  static_assert(lanes % Floats::size() == 0);
  std::array<Words, 4> x;
  philox(first, rest, key, x);
  const auto load = [](const std::uint32_t* from) {
    return Ints([from](auto i) { return static_cast<std::int32_t>(from[i]); });
  };
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t i = 0; i < lanes; i += Floats::size()) {
      // By way of signed conversions, which are one instruction: (word + ½)/2³² in (0, 1) …
      const Ints top = (load(&x[2 * half][i]) >> 1) & 0x7FFFFFFF;
      const Floats uniform = stdx::static_simd_cast<Floats>(top) * 0x1p-31F + 0x1p-33F;
      // … and an angle of −½ … ½ turns; h is half of it in radians.
      const Floats h =
          stdx::static_simd_cast<Floats>(load(&x[2 * half + 1][i])) * (0x1p-32F * 3.14159265F);
      Floats c, s;
      cos_sin_of_half(h, c, s);
      const Floats twice = s + s;
      const Floats radius = sqrt(max(-2.0F * logarithm(uniform), Floats(0.0F)));
      // cos of the angle, 1 − 2 sin²h, and sin of it
      (radius - radius * (twice * s)).copy_to(out + 2 * half * lanes + i, stdx::element_aligned);
      (radius * (twice * c)).copy_to(out + (2 * half + 1) * lanes + i, stdx::element_aligned);
    }
  }
}

}  // namespace

void fill_normal(std::span<float> values, std::uint64_t seed, Draw purpose,
                 std::uint32_t realisation, std::uint64_t entity, std::uint64_t first) {
  assert(first % batch == 0);
  const std::array<std::uint32_t, 2> key = random_key(seed, purpose);
  const std::array<std::uint32_t, 3> rest = {realisation, static_cast<std::uint32_t>(entity),
                                             static_cast<std::uint32_t>(entity >> 32)};
  auto block = static_cast<std::uint32_t>(first / 4);  // four normals each
  std::size_t i = 0;
  for (; i + batch <= values.size(); i += batch, block += lanes)
    normals(block, rest, key, values.data() + i);
  if (i < values.size()) {
    std::array<float, batch> last;
    normals(block, rest, key, last.data());
    std::copy_n(last.data(), values.size() - i, values.data() + i);
  }
}

}  // namespace asdic::detail
