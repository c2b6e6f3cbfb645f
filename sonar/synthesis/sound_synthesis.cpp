#include "sonar/synthesis/sound_synthesis.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

/// A channel's period at twice its rate.
std::vector<std::complex<double>> at_twice_the_rate(const Baseband& baseband, std::size_t channel) {
  const std::size_t n = baseband.samples, below = n / 2;
  FftBuffer<std::complex<double>> bins(n), finer(2 * n);
  const auto row = baseband.channel(channel);
  for (std::size_t i = 0; i < n; ++i) bins[i] = std::complex<double>(row[i]);
  ComplexFft<double>(n).forward(bins.data());
  for (std::size_t k = 0; k < n; ++k)
    finer[k < n - below ? k : k + n] = bins[k] / static_cast<double>(n);
  ComplexFft<double>(2 * n).inverse(finer.data());
  return {finer.data(), finer.data() + 2 * n};
}

/// Samples on either side of the record that still belong to its times.
std::ptrdiff_t beside(const Baseband& baseband) {
  return static_cast<std::ptrdiff_t>((baseband.samples - baseband.recorded) / 2);
}

std::size_t wrapped(std::ptrdiff_t i, std::size_t period) {
  const auto n = static_cast<std::ptrdiff_t>(period);
  return static_cast<std::size_t>((i % n + n) % n);
}

}  // namespace

SampledSignal signal_of(const Baseband& baseband, std::size_t channel) {
  const std::vector<std::complex<double>> finer = at_twice_the_rate(baseband, channel);
  const std::ptrdiff_t first = -2 * beside(baseband),
                       last = 2 * static_cast<std::ptrdiff_t>(baseband.recorded) - first;
  std::vector<std::complex<double>> samples;
  samples.reserve(static_cast<std::size_t>(last - first));
  for (std::ptrdiff_t i = first; i < last; ++i) samples.push_back(finer[wrapped(i, finer.size())]);
  const double rate = 2.0 * baseband.sample_rate;
  return {samples, baseband.start + static_cast<double>(first) / rate, rate};
}

double largest_envelope(const Baseband& baseband, std::size_t channel) {
  const std::vector<std::complex<double>> finer = at_twice_the_rate(baseband, channel);
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(finer.size(), 2 * baseband.recorded); ++i)
    largest = std::max(largest, std::abs(finer[i]));
  return largest;
}

void add_resampled(const Baseband& from, Baseband& to) {
  assert(from.channels == to.channels);
  const std::ptrdiff_t overlap = beside(to), recorded = static_cast<std::ptrdiff_t>(to.recorded);
  // Beside a shorter record is what comes round of the sound beyond its other end.
  const double from_end = from.start + static_cast<double>(from.recorded) / from.sample_rate,
               to_end = to.start + static_cast<double>(recorded) / to.sample_rate,
               step = 1.0 / to.sample_rate;
  const double begin = from.start > to.start + step ? from.start : -infinity,
               end = from_end < to_end - step ? from_end : infinity;
  in_parallel(to.channels, [&](std::size_t channel) {
    const SampledSignal signal = signal_of(from, channel);
    std::complex<float>* const row = to.values.data() + channel * to.samples;
    for (std::ptrdiff_t i = -overlap; i < recorded + overlap; ++i) {
      const double t = to.start + static_cast<double>(i) / to.sample_rate;
      if (t < begin || t > end) continue;
      const double cycles = (from.carrier - to.carrier) * t;
      const auto outside = static_cast<double>(std::max(-i, i - recorded + 1));
      const double fade = outside <= 0.0 ? 0.0 : outside / static_cast<double>(overlap + 1);
      row[wrapped(i, to.samples)] +=
          std::complex<float>(signal.at(t) * std::polar(std::pow(std::cos(0.5 * pi * fade), 2),
                                                        2.0 * pi * (cycles - std::round(cycles))));
    }
  });
}

}  // namespace asdic::detail
