#include "sonar/signal/sampled_signal.h"

#include <cmath>

#include "sonar/signal/interpolation_taps.h"
#include "sonar/signal/tap_sums.h"

namespace asdic::detail {
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
  double real = 0.0, imaginary = 0.0;
  at({&t, 1}, {&real, 1}, {&imaginary, 1});
  return {real, imaginary};
}

void SampledSignal::at(std::span<const double> t, std::span<double> real,
                       std::span<double> imaginary) const noexcept {
  static const Taps weights(kaiser_beta);
  constexpr double reach = 0.5 * Taps::taps;
  const auto place = [&](std::size_t i) { return (t[i] - first_) * rate_; };
  const auto within = [&](double p) { return p > -reach && p < count_ - 1.0 + reach; };
  const auto put = [&](std::size_t i, const Taps::Weights& w, double below)
      __attribute__((always_inline)) {
    const auto from =
        static_cast<std::ptrdiff_t>(pad) + static_cast<std::ptrdiff_t>(below) - Taps::before;
    real[i] = gather(w, real_.data() + from);
    imaginary[i] = gather(w, imaginary_.data() + from);
  };
  const auto one = [&](std::size_t i) {
    real[i] = imaginary[i] = 0.0;
    const double position = place(i), below = std::floor(position);
    if (within(position)) put(i, weights.at(position - below), below);
  };
  std::size_t i = 0;
  for (; i + 1 < t.size(); i += 2) {
    const double first = place(i), second = place(i + 1);
    if (!within(first) || !within(second)) {
      one(i);
      one(i + 1);
      continue;
    }
    const double below_first = std::floor(first), below_second = std::floor(second);
    const Taps::Two w = weights.at(first - below_first, second - below_second);
    put(i, w.first, below_first);
    put(i + 1, w.second, below_second);
  }
  if (i < t.size()) one(i);
}

}  // namespace asdic::detail
