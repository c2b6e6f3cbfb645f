#pragma once
#include <limits>

namespace asdic::detail::study {

/// What a row holds where there is nothing to measure.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace asdic::detail::study
