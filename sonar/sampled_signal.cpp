#include "sonar/sampled_signal.h"

#include <cmath>

#include "sonar/interpolation_taps.h"

namespace asdic {
namespace {

/// 16 taps: A = 2.285·15·2π(1 − ½) + 8 = 115 dB, β = 0.1102(A − 8.7).
using Taps = InterpolationTaps<double, 16>;
constexpr double kaiser_beta = 11.8;
constexpr std::size_t pad = Taps::taps;  // zeros at either end

}  // namespace

SampledSignal::SampledSignal(const std::vector<std::complex<double>>& samples, double first,
                             double rate)
    : real_(samples.size() + 2 * pad),
      imaginary_(real_.size()),
      first_(first),
      rate_(rate),
      count_(static_cast<double>(samples.size())) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    real_[i + pad] = samples[i].real();
    imaginary_[i + pad] = samples[i].imag();
  }
}

std::complex<double> SampledSignal::at(double t) const noexcept {
  static const Taps weights(kaiser_beta);
  const double position = (t - first_) * rate_;
  constexpr double reach = 0.5 * Taps::taps;
  if (!(position > -reach && position < count_ - 1.0 + reach)) return 0.0;
  const double below = std::floor(position);
  const Taps::Weights w = weights.at(position - below);
  const auto from =
      static_cast<std::ptrdiff_t>(pad) + static_cast<std::ptrdiff_t>(below) - Taps::before;
  using Under = Eigen::Map<const Taps::Weights>;
  return {(w * Under(real_.data() + from)).sum(), (w * Under(imaginary_.data() + from)).sum()};
}

}  // namespace asdic
