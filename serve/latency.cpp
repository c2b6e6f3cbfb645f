#include "serve/latency.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace asdic::detail::serve {

void LatencyLog::add(double seconds) noexcept {
  latest_[count_ % latest_.size()] = seconds;
  ++count_;
  longest_ = std::max(longest_, seconds);
}

double LatencyLog::percentile(double p) const {
  const std::size_t n = std::min(count_, latest_.size());
  if (n == 0) return 0.0;
  std::vector<double> sorted(latest_.begin(), latest_.begin() + static_cast<std::ptrdiff_t>(n));
  const auto rank = static_cast<std::size_t>(std::ceil(p * static_cast<double>(n)));  // nearest
  const auto at =
      sorted.begin() + static_cast<std::ptrdiff_t>(std::clamp(rank, std::size_t{1}, n) - 1);
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace asdic::detail::serve
