#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "reverb/pairs/transmit_pattern.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail::support {

/// Speaks into one sector only.
class Sector final : public TransmitPattern {
 public:
  explicit Sector(double half_width) : half_width_(half_width) {}
  [[nodiscard]] std::complex<double> towards(double bearing, double) const noexcept override {
    return std::abs(bearing) < half_width_ ? 1.0 : 0.0;
  }

 private:
  double half_width_;
};

/// Power of a beam (one weight a phone) at frequencies off the carrier, mean over pings: a Hann
/// window from `from` to `to`.
inline std::vector<double> spectrum(const Baseband& received,
                                    std::span<const std::complex<double>> beam, double from,
                                    double to, std::span<const double> frequencies) {
  std::vector<std::complex<double>> sum(frequencies.size());
  const auto first = static_cast<std::size_t>((from - received.start) * received.sample_rate);
  const auto last = static_cast<std::size_t>((to - received.start) * received.sample_rate);
  for (std::size_t i = first; i < last; ++i) {
    std::complex<double> x = 0.0;
    for (std::size_t n = 0; n < beam.size(); ++n)
      x += beam[n] * std::complex<double>(received.channel(n)[i]);
    x *= 0.5 - 0.5 * std::cos(2.0 * pi * double(i - first) / double(last - first));
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += x * std::polar(1.0, -2.0 * pi * frequencies[k] * double(i) / received.sample_rate);
  }
  std::vector<double> power;
  for (const auto& value : sum) power.push_back(std::norm(value));
  return power;
}

/// Centre of the peak: the mean of the frequencies within 6 dB of the largest.
inline double ridge(std::span<const double> power, std::span<const double> frequencies) {
  const double most = *std::max_element(power.begin(), power.end());
  double sum = 0.0, weight = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k)
    if (power[k] > 0.25 * most) sum += power[k] * frequencies[k], weight += power[k];
  return sum / weight;
}

}  // namespace asdic::detail::support
