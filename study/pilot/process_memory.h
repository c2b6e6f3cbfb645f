#pragma once
#include <functional>

namespace asdic::detail::study {

/// What this process holds [bytes]; NaN where the system does not tell.
[[nodiscard]] double resident_bytes();

/// What a piece of work takes at its peak beyond what the process held before [bytes]; NaN where
/// the system does not tell. What earlier work has left unused is given back first, so that it does
/// not count as the work's nor hide it.
[[nodiscard]] double taken_by(const std::function<void()>& work);

}  // namespace asdic::detail::study
