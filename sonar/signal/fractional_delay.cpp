#include "sonar/signal/fractional_delay.h"

#include <array>
#include <cmath>

#include "core/units.h"
#include "sonar/signal/kaiser_window.h"

namespace asdic::detail {

FractionalDelay::FractionalDelay() : weights_((places + 1) * taps) {
  constexpr double beta = 10.0;  // 0.1102(A − 8.7) for A = 100 dB
  constexpr double half = 0.5 * taps;
  constexpr int before = taps / 2 - 1;
  for (int place = 0; place <= places; ++place) {
    for (int tap = 0; tap < taps; ++tap) {
      const double x = tap - before - static_cast<double>(place) / places;
      const double sinc = x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x);
      weights_[static_cast<std::size_t>(place) * taps + static_cast<std::size_t>(tap)] =
          static_cast<float>(sinc * kaiser_window(x / half, beta));
    }
  }
}

std::complex<float> FractionalDelay::operator()(const float* at, float fraction) const noexcept {
  const float place = fraction * places;
  const int before = static_cast<int>(place);
  const float share = place - static_cast<float>(before);
  const float* a = weights_.data() + before * taps;
  const float* q = at - 2 * (taps / 2 - 1);
  std::array<float, taps> weight;
  for (int i = 0; i < taps; ++i)
    weight[static_cast<std::size_t>(i)] = a[i] + share * (a[i + taps] - a[i]);
  float real = 0.0F, imaginary = 0.0F;
  for (int i = 0; i < taps; ++i) {
    real += weight[static_cast<std::size_t>(i)] * q[2 * i];
    imaginary += weight[static_cast<std::size_t>(i)] * q[2 * i + 1];
  }
  return {real, imaginary};
}

}  // namespace asdic::detail
