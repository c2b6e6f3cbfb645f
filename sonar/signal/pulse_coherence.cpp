#include "sonar/signal/pulse_coherence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "sonar/signal/fft.h"
#include "sonar/signal/pulse.h"
#include "sonar/signal/pulse_spectrum.h"

namespace asdic::detail {

namespace {

/// R(Δ) = Σ|C(ν)|²e^{i2πνΔ} / Σ|C|², over the band that holds 99 % of the energy.
PulseCoherence coherence_of(const Pulse& pulse) {
  constexpr double dense = 16.0;
  const PulseSpectrum spectrum = pulse_spectrum(pulse, pulse.centre_frequency());
  const std::size_t all = spectrum.bins.size();
  const auto half = std::min(
      all / 2 - 1, static_cast<std::size_t>(0.5 * pulse.bandwidth_99() / spectrum.bin_width) + 1);
  const std::size_t length =
      fast_fft_length(static_cast<std::size_t>(2.0 * dense * static_cast<double>(half)));
  FftBuffer<std::complex<double>> power(length);
  double sum = 0.0;
  const auto put = [&](std::size_t from, std::size_t to) {
    power[to] = std::norm(spectrum.bins[from]);
    sum += power[to].real();
  };
  for (std::size_t k = 0; k <= half; ++k) put(k, k);
  for (std::size_t k = 1; k <= half; ++k) put(all - k, length - k);
  ComplexFft<double>(length).inverse(power.data());
  const double step = 1.0 / (spectrum.bin_width * static_cast<double>(length));
  const auto count = static_cast<std::size_t>(std::ceil(pulse.duration() / step)) + 1;
  std::vector<std::complex<float>> samples;
  for (std::size_t i = 0; i < count; ++i) samples.emplace_back(power[i] / sum);
  return {pulse.duration(), step, std::move(samples)};
}

}  // namespace

std::shared_ptr<const PulseCoherence> pulse_coherence(const Pulse& pulse) {
  struct Known {
    PulseSettings settings;
    std::shared_ptr<const PulseCoherence> coherence;
  };
  thread_local std::array<Known, 4> known;
  thread_local std::size_t next = 0;
  for (const Known& k : known)
    if (k.coherence && k.settings == pulse.settings()) return k.coherence;
  auto found = std::make_shared<const PulseCoherence>(coherence_of(pulse));
  known[next++ % known.size()] = {pulse.settings(), found};
  return found;
}

}  // namespace asdic::detail
