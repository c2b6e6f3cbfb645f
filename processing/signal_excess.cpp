#include "processing/signal_excess.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "sonar/noise/noise_coherence.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {

double noise_bandwidth(const Pulse& pulse) {
  const double rate = 2.0 * pulse.bandwidth_40db();
  const auto samples =
      static_cast<std::size_t>(std::clamp(pulse.duration() * rate, 64.0, 1048576.0));
  const ComplexFft<double> transform(fast_fft_length(2 * samples));
  FftBuffer<std::complex<double>> x(transform.length());
  const double step = pulse.duration() / static_cast<double>(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = (static_cast<double>(k) + 0.5) * step;
    x[k] = pulse.analytic(t) * std::polar(1.0, -2.0 * pi * pulse.centre_frequency() * t);
  }
  transform.forward(x.data());
  double second = 0.0, fourth = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double power = std::norm(x[k]);
    second += power;
    fourth += power * power;
  }
  return second * second / fourth / (step * static_cast<double>(transform.length()));
}

MatchedFilterGain matched_filter_gain(const Pulse& pulse) {
  return {.noise_db = db_from_power(pulse.energy() * pulse.bandwidth_40db()),
          .reverberation_db = db_from_power(pulse.energy() * noise_bandwidth(pulse))};
}

double signal_excess_db(const BeamLevels& levels, const MatchedFilterGain& gain,
                        double threshold_db) {
  return levels.echo_db -
         db_from_power(power_from_db(levels.reverberation_db - gain.reverberation_db) +
                       power_from_db(levels.noise_db - gain.noise_db)) -
         threshold_db;
}

std::vector<std::complex<double>> noise_coherences(std::span<const Vec3> phones, double wavenumber,
                                                   const NoiseField& noise) {
  const std::size_t n = phones.size();
  std::vector<std::complex<double>> coherence(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      coherence[i * n + j] = noise.coherence == NoiseCoherence::independent
                                 ? std::complex<double>(i == j ? 1.0 : 0.0)
                                 : noise_coherence(noise.coherence, noise.directions,
                                                   phones[i] - phones[j], wavenumber);
  return coherence;
}

double gain_over_noise_db(std::span<const Vec3> phones, const Vec3& slowness,
                          double angular_frequency,
                          std::span<const std::complex<double>> coherence) {
  const std::size_t n = phones.size();
  std::vector<std::complex<double>> turned(n);
  for (std::size_t i = 0; i < n; ++i)
    turned[i] = std::polar(1.0, angular_frequency * slowness.dot(phones[i]));
  double kept = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    std::complex<double> row = 0.0;
    for (std::size_t j = 0; j < n; ++j) row += coherence[i * n + j] * std::conj(turned[j]);
    kept += std::real(turned[i] * row);
  }
  return -db_from_power(kept / static_cast<double>(n * n));
}

}  // namespace asdic::detail
