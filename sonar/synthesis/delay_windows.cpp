#include "sonar/synthesis/delay_windows.h"

#include <cmath>

#include "core/units.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

/// What an FFT costs [1].
double cost_of(std::size_t length) {
  const auto n = static_cast<double>(length);
  return n * std::log2(n);
}

/// Windows of `width`: the next begins at the first sample that the last does not hold.
std::vector<std::size_t> covering(std::span<const std::size_t> samples, std::size_t width) {
  std::vector<std::size_t> begins;
  for (const std::size_t sample : samples)
    if (begins.empty() || sample >= begins.back() + width) begins.push_back(sample);
  return begins;
}

}  // namespace

bool DelayWindows::fit(std::span<const std::size_t> samples, std::size_t margin,
                       std::size_t whole) {
  beside = 2 * margin;
  if (2 * length < 3 * beside || length == 0) {
    const bool first = length == 0;
    double least = first ? cost_of(whole) : infinity;
    for (const double times : {1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0}) {
      const std::size_t tried =
          fast_fft_length(static_cast<std::size_t>(std::ceil(times * static_cast<double>(beside))));
      if (first && tried >= whole) break;
      const double cost =
          static_cast<double>(covering(samples, tried - beside).size()) * cost_of(tried);
      if (cost >= least) continue;
      least = cost;
      length = tried;
    }
    if (length == 0) return false;
  }
  begins = covering(samples, width());
  return true;
}

}  // namespace asdic::detail
