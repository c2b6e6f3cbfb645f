#include "sonar/signal/fractional_delay.h"

#include <array>
#include <cmath>

#include "sonar/signal/tap_sums.h"
#include "sonar/signal/windowed_sinc.h"

namespace asdic::detail {

FractionalDelay::FractionalDelay() : weights_((places + 2) * taps) {
  constexpr double beta = 10.0;  // 0.1102(A − 8.7) for A = 100 dB
  constexpr int before = taps / 2 - 1;
  for (int place = 0; place <= places; ++place) {
    for (int tap = 0; tap < taps; ++tap) {
      const double x = tap - before - static_cast<double>(place) / places;
      weights_[static_cast<std::size_t>(place) * taps + static_cast<std::size_t>(tap)] =
          static_cast<float>(windowed_sinc(x, taps, beta));
    }
  }
}

const FractionalDelay& FractionalDelay::shared() {
  static const FractionalDelay one;
  return one;
}

std::complex<float> FractionalDelay::at(const float* samples, std::int64_t first,
                                        double place) const noexcept {
  const double whole = std::floor(place);
  const float in_table = static_cast<float>(place - whole) * places;
  const int before = static_cast<int>(in_table);
  const float share = in_table - static_cast<float>(before);
  const float* a = weights_.data() + before * taps;
  const float* q = samples + 2 * (static_cast<std::int64_t>(whole) - first - (taps / 2 - 1));
  std::array<float, taps> weight;
  for (int i = 0; i < taps; ++i)
    weight[static_cast<std::size_t>(i)] = a[i] + share * (a[i + taps] - a[i]);
  const auto [real, imaginary] =
      gather<float, taps, 2>([&](std::size_t k) { return weight[k]; },
                             [&](std::size_t k, std::size_t part) { return q[2 * k + part]; });
  return {real, imaginary};
}

}  // namespace asdic::detail
