#include "processing/replica.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

// The spectrum of a pulse of length T, its middle at 0, is a signal "of band ±T/2" over frequency;
// at this many samples per 1/T it is oversampled four times, twice what SampledSignal asks for.
constexpr std::size_t points_per_sample = 4;

void check(std::size_t samples, double sample_rate) {
  if (samples < 2)
    throw InputError({.where = "replica",
                      .got = std::to_string(samples) + " samples",
                      .expected = "at least 2"});
  if (!(sample_rate > 0.0))
    throw InputError({.where = "replica",
                      .got = "a sample rate of " + std::to_string(sample_rate) + " Hz",
                      .expected = "one above 0 Hz"});
}

}  // namespace

Replica::Replica(std::span<const float> samples, double sample_rate) {
  check(samples.size(), sample_rate);
  duration_ = static_cast<double>(samples.size()) / sample_rate;
  const std::size_t n = fast_fft_length(points_per_sample * samples.size());
  FftBuffer<double> real(n);
  std::copy(samples.begin(), samples.end(), real.data());
  const RealFft<double> fft(n);
  FftBuffer<std::complex<double>> bins(fft.bins());
  fft.forward(real.data(), bins.data());
  std::vector<std::complex<double>> analytic(bins.data(), bins.data() + fft.bins());
  for (auto& x : analytic) x *= 2.0 / sample_rate;  // positive frequencies alone, doubled
  analytic.front() *= 0.5;
  measure(std::move(analytic), 0.0, sample_rate / static_cast<double>(n));
}

Replica::Replica(std::span<const std::complex<float>> envelope, double sample_rate,
                 double carrier) {
  check(envelope.size(), sample_rate);
  duration_ = static_cast<double>(envelope.size()) / sample_rate;
  const std::size_t n = fast_fft_length(points_per_sample * envelope.size());
  FftBuffer<std::complex<double>> bins(n);
  std::copy(envelope.begin(), envelope.end(), bins.data());
  ComplexFft<double>(n).forward(bins.data());
  std::vector<std::complex<double>> sorted(n);
  const std::size_t negative = n / 2;  // bins below the carrier
  for (std::size_t k = 0; k < n; ++k) sorted[k] = bins[(k + n - negative) % n] / sample_rate;
  const double spacing = sample_rate / static_cast<double>(n);
  measure(std::move(sorted), carrier - static_cast<double>(negative) * spacing, spacing);
}

void Replica::measure(std::vector<std::complex<double>> bins, double first, double spacing) {
  double peak = 0.0, squares = 0.0, moment = 0.0, fourth = 0.0;
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const double power = std::norm(bins[k]), f = first + static_cast<double>(k) * spacing;
    peak = std::max(peak, power);
    squares += power;
    moment += power * f;
    fourth += power * power;
  }
  if (!(peak > 0.0) || !std::isfinite(squares))
    throw InputError({.where = "replica",
                      .got = peak > 0.0 ? "nan or infinity" : "silence",
                      .expected = "the samples of a pulse"});
  energy_ = squares * spacing;  // Parseval: ∫|s₊|²dt = ∫|S|²df
  centre_ = moment / squares;
  noise_bandwidth_ = squares * squares / fourth * spacing;
  const auto loud = [&](const std::complex<double>& x) { return std::norm(x) >= 1e-4 * peak; };
  const auto low = std::find_if(bins.begin(), bins.end(), loud);
  const auto high = std::find_if(bins.rbegin(), bins.rend(), loud);
  lowest_ = first + static_cast<double>(low - bins.begin()) * spacing;
  highest_ = first + static_cast<double>(bins.rend() - high - 1) * spacing;
  for (std::size_t k = 0; k < bins.size(); ++k) {  // the pulse's middle to t = 0
    const double f = first + static_cast<double>(k) * spacing;
    bins[k] *= std::polar(1.0, std::remainder(pi * f * duration_, 2.0 * pi));
  }
  spectrum_ = SampledSignal(bins, first, 1.0 / spacing);
}

std::complex<double> Replica::spectrum(double frequency, double doppler) const noexcept {
  const double f = frequency / doppler;
  return spectrum_.at(f) / doppler * std::polar(1.0, std::remainder(-pi * f * duration_, 2.0 * pi));
}

}  // namespace asdic::detail
