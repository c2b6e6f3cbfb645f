#include "reverb/power/pulse_coherence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/mixed_bits.h"

namespace asdic::detail {

PulseCoherence::PulseCoherence(double duration, double step,
                               std::vector<std::complex<float>> samples)
    : duration_(duration), lasting_(duration), step_(step), samples_(std::move(samples)) {
  constexpr float nothing = 0.01F;
  const auto last = std::find_if(samples_.rbegin(), samples_.rend(), [](const auto& sample) {
    return std::norm(sample) >= nothing * nothing;
  });
  if (!samples_.empty())  // the line to the sample after the last is above it, too
    lasting_ = std::min(duration, step * static_cast<double>(samples_.rend() - last));
  for (const std::complex<float>& sample : samples_)
    fingerprint_ = mixed(fingerprint_, std::bit_cast<std::uint64_t>(sample));
}

std::complex<double> PulseCoherence::operator()(double later) const noexcept {
  const double by = std::abs(later);
  if (by >= duration_) return 0.0;
  if (samples_.empty()) return 1.0;
  const double at = by / step_;
  const auto i = static_cast<std::size_t>(at);
  const auto t = static_cast<float>(at - static_cast<double>(i));
  const std::complex<double> found = samples_[i] + t * (samples_[i + 1] - samples_[i]);
  return later < 0.0 ? std::conj(found) : found;
}

}  // namespace asdic::detail
