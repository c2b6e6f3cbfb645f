#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

namespace asdic::detail {

/// Width of the bins of delay in which power is summed: a sixteenth of the pulse [s].
[[nodiscard]] inline double delay_bin(double pulse_duration, double latest) noexcept {
  constexpr double most_bins = 16'000.0, widest = 0.1;  // [1], [s]
  return std::max(std::min(pulse_duration / 16.0, widest), latest / most_bins);
}

/// Adds a power that is received evenly from `first` to `last` [bins].
template <class Number>
void spread(double power, double first, double last, std::span<Number> bins) noexcept {
  const double all = static_cast<double>(bins.size());
  first = std::clamp(first, 0.0, all);
  last = std::clamp(last, first, all);
  const auto begin = static_cast<std::size_t>(first);
  if (begin >= bins.size()) return;
  if (last - first < 1e-9) {
    bins[begin] += static_cast<Number>(power);
    return;
  }
  const double each = power / (last - first);
  for (std::size_t i = begin; i < bins.size() && static_cast<double>(i) < last; ++i) {
    const double from = std::max(first, static_cast<double>(i));
    bins[i] += static_cast<Number>(each * (std::min(last, static_cast<double>(i) + 1.0) - from));
  }
}

}  // namespace asdic::detail
