#pragma once
#include <cstdint>

namespace asdic::detail {

/// Mixes numbers into one of 64 bits (SplitMix64's finaliser): the name of a thing in its draws.
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t a, std::uint64_t b) noexcept {
  std::uint64_t z = (a ^ (b * 0xD6E8FEB86659FD93ULL)) + 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// A draw out of 64 random bits, 53 of which it takes: uniform in (0, 1), up to rounding (1 comes
/// once in 2⁵³).
[[nodiscard]] constexpr double uniform_of_bits(std::uint64_t bits) noexcept {
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

}  // namespace asdic::detail
