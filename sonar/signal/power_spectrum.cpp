#include "sonar/signal/power_spectrum.h"

#include <cassert>
#include <cmath>

#include "core/units.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

/// sin²(πi/L): of segments that are half over one another they add up to 1.
std::vector<double> hann(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double s = std::sin(pi * static_cast<double>(i) / static_cast<double>(length));
    window[i] = s * s;
  }
  return window;
}

/// \param transform  given a segment's first sample, adds |X(k)|² to the density
template <class Transform>
int add_segments(std::size_t samples, std::size_t length, const Transform& transform) {
  assert(length >= 2 && length % 2 == 0 && length <= samples);
  int segments = 0;
  for (std::size_t first = 0; first + length <= samples; first += length / 2, ++segments)
    transform(first);
  return segments;
}

/// Σ w² of the window.
double energy(const std::vector<double>& window) {
  double sum = 0.0;
  for (const double w : window) sum += w * w;
  return sum;
}

}  // namespace

PowerSpectrum power_spectrum(std::span<const float> pressure, double sample_rate,
                             std::size_t length) {
  const RealFft<double> fft(length);
  FftBuffer<double> x(length);
  FftBuffer<std::complex<double>> bins(fft.bins());
  const std::vector<double> window = hann(length);
  PowerSpectrum made{.first_frequency = 0.0,
                     .frequency_step = sample_rate / static_cast<double>(length),
                     .density = std::vector<double>(fft.bins(), 0.0)};
  made.segments = add_segments(pressure.size(), length, [&](std::size_t first) {
    for (std::size_t i = 0; i < length; ++i)
      x[i] = static_cast<double>(pressure[first + i]) * window[i];
    fft.forward(x.data(), bins.data());
    for (std::size_t k = 0; k < fft.bins(); ++k) made.density[k] += std::norm(bins[k]);
  });
  const double scale = 1.0 / (made.segments * sample_rate * energy(window));
  for (std::size_t k = 0; k < fft.bins(); ++k)
    made.density[k] *= k == 0 || k == length / 2 ? scale : 2.0 * scale;
  return made;
}

PowerSpectrum power_spectrum(std::span<const std::complex<float>> envelope, double sample_rate,
                             double carrier, std::size_t length) {
  const ComplexFft<double> fft(length);
  FftBuffer<std::complex<double>> x(length);
  const std::vector<double> window = hann(length);
  const double step = sample_rate / static_cast<double>(length);
  const std::size_t half = length / 2;  // bins from here on are those below the carrier
  PowerSpectrum made{.first_frequency = carrier - static_cast<double>(half) * step,
                     .frequency_step = step,
                     .density = std::vector<double>(length, 0.0)};
  made.segments = add_segments(envelope.size(), length, [&](std::size_t first) {
    for (std::size_t i = 0; i < length; ++i)
      x[i] = static_cast<std::complex<double>>(envelope[first + i]) * window[i];
    fft.forward(x.data());
    for (std::size_t k = 0; k < length; ++k) made.density[(k + half) % length] += std::norm(x[k]);
  });
  const double scale = 0.5 / (made.segments * sample_rate * energy(window));
  for (double& s : made.density) s *= scale;
  return made;
}

std::size_t segment_length(double sample_rate, double step) {
  const double whole = std::ceil(0.5 * sample_rate / step * (1.0 - 1e-12));
  return 2 * fast_fft_length(static_cast<std::size_t>(std::max(1.0, whole)));
}

}  // namespace asdic::detail
