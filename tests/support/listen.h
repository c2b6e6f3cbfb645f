#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include "sonar/ping/ping_record.h"
#include "sonar/signal/fft.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail::support {

/// What an observer measures who has the phones' samples and nothing else.

/// The pressure [Pa] of every phone, band-passed to carrier ± half_band and mixed down: Re{b
/// e^{iωt}} is the pressure in that band, |b| its peak envelope. A brick wall in frequency over the
/// record.
inline Baseband demodulate(const PingRecord& record, double carrier, double half_band) {
  const std::size_t n = record.recording.samples;
  const RealFft<double> forward(fast_fft_length(n));
  const auto length = static_cast<double>(forward.length());
  const double bin = record.recording.sample_rate / length;
  const auto centre = std::llround(carrier / bin), half = std::llround(half_band / bin);
  const ComplexFft<double> back(fast_fft_length(static_cast<std::size_t>(8 * half)));
  Baseband received{.carrier = static_cast<double>(centre) * bin,
                    .sample_rate = bin * static_cast<double>(back.length()),
                    .start = record.recording.start,
                    .channels = record.phones.size(),
                    .samples = back.length(),
                    .recorded = static_cast<std::size_t>(static_cast<double>(back.length()) *
                                                         static_cast<double>(n) / length)};
  received.values.reserve(received.channels * received.samples);
  FftBuffer<double> samples(forward.length());
  FftBuffer<std::complex<double>> bins(forward.bins()), mixed(back.length());
  for (std::size_t channel = 0; channel < received.channels; ++channel) {
    samples.clear();
    for (std::size_t i = 0; i < n; ++i)
      samples[i] = static_cast<double>(record.pressure[channel * n + i]);
    forward.forward(samples.data(), bins.data());
    mixed.clear();
    for (auto j = -half; j <= half; ++j)  // x = Re b e^{iωt}: X_k = (N/2)·B_{k − k₀}
      mixed[static_cast<std::size_t>(j < 0 ? j + static_cast<long long>(back.length()) : j)] =
          2.0 / length * bins[static_cast<std::size_t>(centre + j)];
    back.inverse(mixed.data());
    // The mixer's phase is that of t = 0 of the ping.
    const auto turn = std::polar(1.0, -2.0 * pi * received.carrier * received.start);
    for (std::size_t i = 0; i < back.length(); ++i)
      received.values.emplace_back(std::complex<float>(mixed[i] * turn));
  }
  return received;
}

/// The mean over the phones: a beam at broadside. [recorded]
inline std::vector<std::complex<double>> broadside(const Baseband& received) {
  std::vector<std::complex<double>> sum(received.recorded);
  for (std::size_t n = 0; n < received.channels; ++n)
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] +=
          std::complex<double>(received.channel(n)[i]) / static_cast<double>(received.channels);
  return sum;
}

/// The largest envelope between two times [s].
struct Peak {
  double time = 0.0;      ///< [s]
  double level_db = 0.0;  ///< envelope/√2 [dB re 1 µPa]
};
inline Peak peak(const Baseband& received, std::span<const std::complex<double>> row, double from,
                 double to) {
  Peak best{.level_db = -infinity};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double t = received.start + static_cast<double>(i) / received.sample_rate;
    const double level = db_from_amplitude(std::abs(row[i]) / std::numbers::sqrt2 / micropascal);
    if (t >= from && t < to && level > best.level_db) best = {.time = t, .level_db = level};
  }
  return best;
}

/// Frequency [Hz] by the slope of the phase between two times, weighted by the power: the
/// centroid of the spectrum (Parseval), ∫ Im(b* ḃ)/∫|b|²/2π, by the pair product at one step.
inline double frequency(const Baseband& received, std::span<const std::complex<double>> row,
                        double from, double to) {
  std::complex<double> turn = 0.0;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) {
    const double t = received.start + static_cast<double>(i) / received.sample_rate;
    if (t >= from && t < to) turn += row[i + 1] * std::conj(row[i]);
  }
  return received.carrier + std::arg(turn) * received.sample_rate / (2.0 * pi);
}

/// One-sided spectral density by Welch's method, Hann windows of `length` half overlapped,
/// averaged over the phones. [length/2 + 1] Pa²/Hz
inline std::vector<double> welch(const PingRecord& record, std::size_t length, double from,
                                 double to) {
  const RealFft<double> fft(length);
  FftBuffer<double> x(length);
  FftBuffer<std::complex<double>> bins(fft.bins());
  std::vector<double> density(fft.bins());
  const double rate = record.recording.sample_rate;
  const auto first = static_cast<std::size_t>((from - record.recording.start) * rate);
  const auto last = static_cast<std::size_t>((to - record.recording.start) * rate);
  double segments = 0.0;
  for (std::size_t channel = 0; channel < record.phones.size(); ++channel)
    for (std::size_t s = first; s + length <= last; s += length / 2) {
      for (std::size_t i = 0; i < length; ++i)
        x[i] = static_cast<double>(record.pressure[channel * record.recording.samples + s + i]) *
               (0.5 - 0.5 * std::cos(2.0 * pi * static_cast<double>(i) / double(length)));
      fft.forward(x.data(), bins.data());
      for (std::size_t k = 0; k < density.size(); ++k) density[k] += std::norm(bins[k]);
      segments += 1.0;
    }
  for (double& d : density) d *= 2.0 / (segments * rate * 0.375 * static_cast<double>(length));
  return density;
}

}  // namespace asdic::detail::support
