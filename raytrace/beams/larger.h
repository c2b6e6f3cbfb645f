#pragma once

/// Of two numbers, as loops take it that are to vectorise: no reference, and no rule for NaN.
namespace asdic::detail::beams {

[[nodiscard]] constexpr double larger(double a, double b) noexcept { return a > b ? a : b; }
[[nodiscard]] constexpr double smaller(double a, double b) noexcept { return a < b ? a : b; }

}  // namespace asdic::detail::beams
