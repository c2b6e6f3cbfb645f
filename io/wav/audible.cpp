#include "io/wav/audible.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace asdic::detail {
namespace {

constexpr double least_rate = 8000.0;  // of sound that any player plays [Hz]

/// Kaiser's window of β = 8, by the series of the Bessel function I₀. \param x  −1 to 1
double kaiser(double x) {
  const auto bessel = [](double z) {
    double sum = 1.0, term = 1.0;
    for (int n = 1; n < 40; ++n) sum += term *= z * z / (4.0 * n * n);
    return sum;
  };
  constexpr double beta = 8.0;
  return std::abs(x) >= 1.0 ? 0.0 : bessel(beta * std::sqrt(1.0 - x * x)) / bessel(beta);
}

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-9 ? 1.0 : std::sin(angle) / angle;
}

}  // namespace

double Audible::usual_tone(double sample_rate) { return std::max(1000.0, 0.5 * sample_rate); }

Audible::Audible(double sample_rate, double tone)
    : rate_(sample_rate),
      tone_(tone),
      factor_(static_cast<int>(
          std::ceil(std::max(least_rate, 2.2 * (tone + 0.5 * sample_rate)) / sample_rate))),
      kernel_(static_cast<std::size_t>(factor_ * 2 * reach)),
      past_(2 * (reach - 1), 0.0F) {
  for (int phase = 0; phase < factor_; ++phase)
    for (int n = 0; n < 2 * reach; ++n) {  // sample n − reach + 1 from the one before the place
      const double away = double(phase) / factor_ - (n - reach + 1);
      kernel_[static_cast<std::size_t>(phase * 2 * reach + n)] =
          static_cast<float>(sinc(away) * kaiser(away / reach));
    }
}

std::vector<float> Audible::take(std::span<const float> baseband) {
  past_.insert(past_.end(), baseband.begin(), baseband.end());
  const std::size_t there = past_.size() / 2;
  std::vector<float> heard;
  std::size_t first = 0;  // of the samples that the next one is made of
  while (first + 2 * reach <= there) {
    const int phase = static_cast<int>(next_ % factor_);
    const float* const weight = &kernel_[static_cast<std::size_t>(phase * 2 * reach)];
    const float* const x = &past_[2 * first];
    float real = 0.0F, imaginary = 0.0F;
    for (std::size_t n = 0; n < 2 * reach; ++n) {
      real += weight[n] * x[2 * n];
      imaginary += weight[n] * x[2 * n + 1];
    }
    const double cycles = static_cast<double>(next_) * tone_ / rate();
    const double angle = 2.0 * std::numbers::pi * (cycles - std::floor(cycles));
    heard.push_back(
        static_cast<float>(double(real) * std::cos(angle) - double(imaginary) * std::sin(angle)));
    if (++next_ % factor_ == 0) ++first;
  }
  past_.erase(past_.begin(), past_.begin() + static_cast<std::ptrdiff_t>(2 * first));
  return heard;
}

std::vector<float> Audible::rest() {
  const std::vector<float> silence(2 * reach, 0.0F);
  return take(silence);
}

}  // namespace asdic::detail
