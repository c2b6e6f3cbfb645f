#pragma once
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <vector>

#include "support/reverberant_sea.h"

namespace asdic::detail::support {

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
    const Baseband received = sea.receive(ping);
    for (double t = from; t < to; t += step, found.count += 1.0) {
      Eigen::VectorXcd b(phones);
      for (Eigen::Index n = 0; n < phones; ++n) b[n] = at(received, std::size_t(n), t);
      b /= std::sqrt(power_from_db(first.expected_db(t) - level));
      found.mean += b.conjugate() * b.transpose();
    }
  }
  found.mean /= found.count;
  return found;
}

/// Reverberation has the covariances between phones of the plain sum over scatterers: 30 pings of
/// 38 times 0.25 s apart (two pulse lengths), 1140 samples each; elements of a sample covariance
/// have a standard deviation of the powers' geometric mean over √count (real and imaginary part
/// 1/√2 of it, or all of it in one), the difference of two √2 of it: 4.9·√2/√1140 = 0.205. The
/// wrong model, phones in another place, must fail.
inline void expect_moments_of_the_plain_sum(const Scenario& s) {
  Scenario plain = s, wrong = s;
  plain.reverberation.synthesis = ScattererSynthesis::scatterers;
  for (Vec3& phone : wrong.arrays[0].phones) phone = Vec3(0.7 * phone.y(), 0.5 * phone.x(), 0.0);
  const auto of = [](const Scenario& sea) {
    return moments(ReverberantSea(sea), 30, 2.5, 12.0, 0.25);
  };
  const Moments a = of(plain), b = of(s), w = of(wrong);
  const double allowed = 4.9 * std::sqrt(2.0 / a.count);
  EXPECT_LT((a.mean - b.mean).cwiseAbs().maxCoeff(), allowed);
  EXPECT_GT((a.mean - w.mean).cwiseAbs().maxCoeff(), allowed);
}

/// Mean of conj(B_m(ν))·B_n(ν) over pings and windows at a frequency off the carrier.
inline std::complex<double> cross_spectrum(const std::vector<Baseband>& pings, std::size_t m,
                                           std::size_t n, double from, double to, double length,
                                           double frequency) {
  std::complex<double> sum = 0.0;
  double count = 0.0;
  for (const Baseband& received : pings)
    for (double start = from; start + length < to; start += length, count += 1.0) {
      std::complex<double> a = 0.0, b = 0.0;
      const auto first = static_cast<std::size_t>((start - received.start) * received.sample_rate);
      const auto samples = static_cast<std::size_t>(length * received.sample_rate);
      for (std::size_t i = 0; i < samples; ++i) {
        const double u = (double(i) + 0.5) / double(samples);
        const std::complex<double> w =
            std::polar((0.5 - 0.5 * std::cos(2.0 * pi * u)) * std::pow(start, 1.5),
                       -2.0 * pi * frequency * double(i) / received.sample_rate);
        a += w * std::complex<double>(received.channel(m)[first + i]);
        b += w * std::complex<double>(received.channel(n)[first + i]);
      }
      sum += std::conj(a) * b;
    }
  return sum / count;
}

}  // namespace asdic::detail::support
