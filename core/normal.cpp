#include "core/normal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

namespace asdic {
namespace {

constexpr std::size_t lanes = 16;         // Philox blocks side by side
constexpr std::size_t batch = 4 * lanes;  // normals they give
using Words = std::array<std::uint32_t, lanes>;

/// Philox4x32-10 of the counters (first…first + lanes, c1, c2, c3): Salmon et al., SC'11, written
/// over lanes so that it vectorises. Tested against Random123.
inline void philox(std::uint32_t first, std::array<std::uint32_t, 3> rest,
                   std::array<std::uint32_t, 2> key, std::array<Words, 4>& x) noexcept {
  for (std::uint32_t i = 0; i < lanes; ++i) {
    x[0][i] = first + i;
    x[1][i] = rest[0];
    x[2][i] = rest[1];
    x[3][i] = rest[2];
  }
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint64_t p0 = std::uint64_t{0xD2511F53U} * x[0][i];
      const std::uint64_t p1 = std::uint64_t{0xCD9E8D57U} * x[2][i];
      const std::uint32_t x1 = x[1][i], x3 = x[3][i];
      x[0][i] = static_cast<std::uint32_t>(p1 >> 32) ^ x1 ^ key[0];
      x[1][i] = static_cast<std::uint32_t>(p1);
      x[2][i] = static_cast<std::uint32_t>(p0 >> 32) ^ x3 ^ key[1];
      x[3][i] = static_cast<std::uint32_t>(p0);
    }
    key[0] += 0x9E3779B9U;  // the golden ratio and √3 − 1
    key[1] += 0xBB67AE85U;
  }
}

/// √(−2 ln u), u in [2⁻³³, 1]: no branch, no library call, so that a loop of it vectorises.
inline float rayleigh_radius(float u) noexcept {
  // u = m·2^e, m in [√½, √2); ln m = 2 artanh f, f = (m − 1)/(m + 1), |f| ≤ 0.172.
  constexpr std::uint32_t root_half = 0x3F3504F3U;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(u) - root_half;
  const auto e = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFU) + root_half);
  const float f = (m - 1.0F) / (m + 1.0F);
  const float g = f * f;
  const float log_m = 2.0F * f * (1.0F + g * (1.0F / 3 + g * (1.0F / 5 + g * (1.0F / 7 + g / 9))));
  const float x = -2.0F * (log_m + 0.69314718F * e);
  // x·x^{−½}, the reciprocal root from its logarithm's bits and three steps of Newton's method.
  float y = std::bit_cast<float>(0x5F3759DFU - (std::bit_cast<std::uint32_t>(x) >> 1));
  for (int step = 0; step < 3; ++step) y *= 1.5F - 0.5F * x * y * y;
  return x * y;
}

/// 64 normals out of the 16 blocks from `first`: words 0 and 2 give radii, 1 and 3 angles.
inline void normals(std::uint32_t first, std::array<std::uint32_t, 3> rest,
                    std::array<std::uint32_t, 2> key, float* __restrict out) noexcept {
  std::array<Words, 4> x;
  philox(first, rest, key, x);
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t i = 0; i < lanes; ++i) {
      // By way of signed conversions, which are one instruction: (word + ½)/2³² in (0, 1) …
      const float uniform =
          static_cast<float>(static_cast<std::int32_t>(x[2 * half][i] >> 1)) * 0x1p-31F + 0x1p-33F;
      // … and an angle of −½ … ½ turns; h is half of it in radians.
      const float h = static_cast<float>(static_cast<std::int32_t>(x[2 * half + 1][i])) *
                      (0x1p-32F * 3.14159265F);
      const float y = h * h;
      // Taylor series of sin h and cos h, below 1e-7 for |h| ≤ π/2.
      const float s =
          h *
          (1.0F +
           y * (-1.66666667e-1F +
                y * (8.33333333e-3F +
                     y * (-1.98412698e-4F +
                          y * (2.75573192e-6F + y * (-2.50521084e-8F + y * 1.60590438e-10F))))));
      const float c =
          1.0F + y * (-0.5F + y * (4.16666667e-2F +
                                   y * (-1.38888889e-3F +
                                        y * (2.48015873e-5F +
                                             y * (-2.75573192e-7F +
                                                  y * (2.08767570e-9F + y * -1.14707456e-11F))))));
      const float radius = rayleigh_radius(uniform);
      out[2 * half * lanes + i] = radius * (c * c - s * s);       // cos of the angle
      out[(2 * half + 1) * lanes + i] = radius * (2.0F * s * c);  // sin
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

}  // namespace asdic
