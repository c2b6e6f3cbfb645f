#include "processing/coverage/filter_weights.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "sonar/signal/fft.h"

namespace asdic::detail {

std::vector<float> filter_weights(const Pulse& pulse, double step, double width) {
  // The envelope, twice as dense as its −40 dB band asks for: its spectrum squared is R.
  const double rate = 2.0 * pulse.bandwidth_40db();
  const auto samples =
      static_cast<std::size_t>(std::clamp(pulse.duration() * rate, 64.0, 1048576.0));
  const ComplexFft<double> transform(fast_fft_length(2 * samples));
  FftBuffer<std::complex<double>> x(transform.length());
  const double dt = pulse.duration() / static_cast<double>(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = (static_cast<double>(k) + 0.5) * dt;
    x[k] = pulse.analytic(t) * std::polar(1.0, -2.0 * pi * pulse.centre_frequency() * t);
  }
  transform.forward(x.data());
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::norm(x[k]);
  transform.inverse(x.data());
  const auto half = static_cast<std::size_t>(std::ceil((pulse.duration() + 0.5 * width) / step));
  std::vector<double> weights(2 * half + 1, 0.0);
  double sum = 0.0;
  // A sample stands for dt, or the width, about itself: shared by the bins that it lies in.
  const double extent = std::max(dt, width);
  const auto add = [&](double later, double power) {
    const double from = (later - 0.5 * extent) / step + static_cast<double>(half) + 0.5,
                 to = from + extent / step;
    const auto last = static_cast<double>(weights.size());
    for (double at = std::max(0.0, from); at < std::min(to, last);) {
      const double end = std::min({std::floor(at) + 1.0, to, last});
      weights[static_cast<std::size_t>(at)] += power * (end - at);
      sum += power * (end - at);
      at = end;
    }
  };
  add(0.0, std::norm(x[0]));
  for (std::size_t k = 1; k < samples; ++k) {
    add(static_cast<double>(k) * dt, std::norm(x[k]));
    add(-static_cast<double>(k) * dt, std::norm(x[k]));
  }
  std::vector<float> shares(weights.size());
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i] = static_cast<float>(pulse.energy() * weights[i] / sum);
  return shares;
}

}  // namespace asdic::detail
