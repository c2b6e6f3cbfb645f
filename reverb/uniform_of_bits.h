#pragma once
#include <cstdint>

namespace asdic::detail {

/// A draw out of 64 random bits (mixed() of reverb/scatterer_field.h), 53 of which it takes:
/// uniform in (0, 1), up to rounding (1 comes once in 2⁵³).
[[nodiscard]] inline double uniform_of_bits(std::uint64_t bits) noexcept {
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

}  // namespace asdic::detail
