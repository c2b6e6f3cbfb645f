#pragma once
#include <cstdint>

namespace asdic::detail::study {

inline constexpr std::size_t most_sobol_dimensions = 64;

/// Coordinate of a point of Sobol's sequence, in natural (not Gray code) order, as 32 binary
/// digits: 2⁻³² of it lies in [0, 1). \param index  below 2³²   \param dimension  from 0, below
/// most_sobol_dimensions
/// Direction numbers: Joe & Kuo, SIAM J. Sci. Comput. 30, 2635 (2008). docs/theory/designs.md
[[nodiscard]] std::uint32_t sobol_digits(std::uint32_t index, std::size_t dimension) noexcept;

/// Nested uniform scrambling (Owen, 1995): digit k is turned over or not by a bit drawn for the
/// k − 1 digits before it. A bijection that keeps every elementary interval whole.
/// \param replicate  below 2³²: of one seed they are independent
[[nodiscard]] std::uint32_t owen_scrambled(std::uint32_t digits, std::uint64_t seed,
                                           std::uint32_t dimension,
                                           std::uint64_t replicate = 0) noexcept;

}  // namespace asdic::detail::study
