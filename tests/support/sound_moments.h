#pragma once
#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <vector>

#include "support/reverberant_sea.h"

namespace asdic::support {

/// ⟨b_m* b_n⟩/expected power over pings and independent times, one sample a step.
struct Moments {
  Eigen::MatrixXcd mean;
  double count = 0.0;
};
inline Moments moments(const ReverberantSea& sea, int pings, double from, double to, double step) {
  const auto phones = static_cast<Eigen::Index>(sea.scenario().arrays[0].phones.size());
  Moments found{.mean = Eigen::MatrixXcd::Zero(phones, phones)};
  const PingReverberation first = sea.ping(1);
  const double level = sea.scenario().transmitters[0].source_level_db;
  for (std::uint32_t ping = 1; ping <= std::uint32_t(pings); ++ping) {
    const Baseband heard = sea.hear(ping);
    for (double t = from; t < to; t += step, found.count += 1.0) {
      Eigen::VectorXcd b(phones);
      for (Eigen::Index n = 0; n < phones; ++n) b[n] = at(heard, std::size_t(n), t);
      b /= std::sqrt(power_from_db(first.expected_db(t) - level));
      found.mean += b.conjugate() * b.transpose();
    }
  }
  found.mean /= found.count;
  return found;
}

/// Mean of conj(B_m(ν))·B_n(ν) over pings and windows at a frequency off the carrier.
inline std::complex<double> cross_spectrum(const std::vector<Baseband>& pings, std::size_t m,
                                           std::size_t n, double from, double to, double length,
                                           double frequency) {
  std::complex<double> sum = 0.0;
  double count = 0.0;
  for (const Baseband& heard : pings)
    for (double start = from; start + length < to; start += length, count += 1.0) {
      std::complex<double> a = 0.0, b = 0.0;
      const auto first = static_cast<std::size_t>((start - heard.start) * heard.sample_rate);
      const auto samples = static_cast<std::size_t>(length * heard.sample_rate);
      for (std::size_t i = 0; i < samples; ++i) {
        const double u = (double(i) + 0.5) / double(samples);
        const std::complex<double> w =
            std::polar((0.5 - 0.5 * std::cos(2.0 * pi * u)) * std::pow(start, 1.5),
                       -2.0 * pi * frequency * double(i) / heard.sample_rate);
        a += w * std::complex<double>(heard.channel(m)[first + i]);
        b += w * std::complex<double>(heard.channel(n)[first + i]);
      }
      sum += std::conj(a) * b;
    }
  return sum / count;
}

}  // namespace asdic::support
