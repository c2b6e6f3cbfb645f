#include "sonar/ping/receiver_electronics.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/random.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

double drawn(const Scenario& scenario, Draw purpose, std::size_t channel) {
  return RandomStream(scenario.seed, purpose, 0, channel).normal();
}

std::complex<double> gain_of(const Scenario& scenario, const Electronics& electronics,
                             std::size_t phone, std::size_t channel) {
  const auto& dead = electronics.dead;
  if (std::find(dead.begin(), dead.end(), static_cast<int>(phone)) != dead.end()) return 0.0;
  double gain_db = electronics.gain_db.empty() ? 0.0 : electronics.gain_db[phone];
  double phase = electronics.phase.empty() ? 0.0 : electronics.phase[phone];
  if (electronics.gain_std_db > 0.0)
    gain_db += electronics.gain_std_db * drawn(scenario, Draw::element_gain, channel);
  if (electronics.phase_std > 0.0)
    phase += electronics.phase_std * drawn(scenario, Draw::element_phase, channel);
  return std::polar(amplitude_from_db(gain_db), phase);
}

}  // namespace

double magnitude(const Electronics::BandPass& filter, double frequency) noexcept {
  const double detuning =
      (frequency * frequency - filter.low * filter.high) / ((filter.high - filter.low) * frequency);
  return 1.0 / std::sqrt(1.0 + std::pow(detuning * detuning, filter.order));
}

ReceiverElectronics::ReceiverElectronics(const Scenario& scenario) {
  for (const ReceiverArray& array : scenario.arrays)
    for (std::size_t phone = 0; phone < array.phones.size(); ++phone) {
      const Electronics& electronics = array.electronics;
      channels_.push_back({.gain = gain_of(scenario, electronics, phone, channels_.size()),
                           .band_pass = electronics.band_pass,
                           .converter = electronics.converter});
      if (channels_.back().gain != 1.0 || electronics.band_pass) flat_ = false;
    }
}

std::complex<double> ReceiverElectronics::response(std::size_t channel,
                                                   double frequency) const noexcept {
  const Channel& one = channels_[channel];
  if (!one.band_pass) return one.gain;
  return frequency > 0.0 ? one.gain * magnitude(*one.band_pass, frequency) : 0.0;
}

void ReceiverElectronics::respond(Baseband& sound) const {
  if (flat_) return;
  assert(sound.channels == channels_.size());
  in_parallel(sound.channels, [&](std::size_t channel) {
    std::complex<float>* row = sound.values.data() + channel * sound.samples;
    if (!channels_[channel].band_pass) {
      const std::complex<float> gain(channels_[channel].gain);
      for (std::size_t i = 0; i < sound.samples; ++i) row[i] *= gain;
      return;
    }
    const ComplexFft<float> fft(sound.samples);
    FftBuffer<std::complex<float>> bins(sound.samples);
    std::copy_n(row, sound.samples, bins.data());
    fft.forward(bins.data());
    const auto n = static_cast<std::ptrdiff_t>(sound.samples);
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const double beside =
          static_cast<double>(2 * k < n ? k : k - n) * sound.sample_rate / static_cast<double>(n);
      bins[static_cast<std::size_t>(k)] *=
          std::complex<float>(response(channel, sound.carrier + beside) / static_cast<double>(n));
    }
    fft.inverse(bins.data());
    std::copy_n(bins.data(), sound.samples, row);
  });
}

/// After which the response of all channels has died away to 10⁻⁵ [s]. The poles of a band-pass
/// that decay slowest do so at π·B·sin(π/2n), or as a low-pass of its lower edge would.
double ReceiverElectronics::memory() const noexcept {
  double longest = 0.0;
  for (const Channel& one : channels_) {
    if (!one.band_pass) continue;
    const auto& [order, low, high] = *one.band_pass;
    const double rate = pi * std::min(high - low, 2.0 * low) * std::sin(0.5 * pi / order);
    longest = std::max(longest, 11.5 / rate);
  }
  return longest;
}

std::size_t ReceiverElectronics::ahead(const Recording& recording) const noexcept {
  if (flat_) return 0;
  // A turn of the phase has no end in time; this many samples hold all but −40 dB of it.
  constexpr std::size_t least = 2048;
  return std::max(least, static_cast<std::size_t>(std::ceil(memory() * recording.sample_rate)));
}

void ReceiverElectronics::respond(std::span<float> received, const Recording& recording,
                                  Carried& carried) const {
  if (flat_) return;
  const std::size_t width = recording.components(), part = recording.samples;
  const std::size_t half = ahead(recording), before = 2 * half,
                    length = fast_fft_length((before + part + 1) / 2) * 2;
  assert(received.size() == channels_.size() * part * width);
  assert(carried.size() == channels_.size() * before * width);
  Carried inputs(channels_.size() * before * width);
  in_parallel(channels_.size(), [&](std::size_t channel) {
    float* row = received.data() + channel * part * width;
    FftBuffer<std::complex<float>> x(length);
    const auto value = [&](std::size_t i) {
      return width == 2 ? std::complex<float>(row[2 * i], row[2 * i + 1])
                        : std::complex<float>(row[i], 0.0F);
    };
    for (std::size_t i = 0; i < before; ++i) {
      const std::size_t at = (channel * before + i) * width;
      x[i] = {carried[at], width == 2 ? carried[at + 1] : 0.0F};
    }
    for (std::size_t i = 0; i < part; ++i) x[before + i] = value(i);
    for (std::size_t i = 0; i < before; ++i) {
      const std::size_t at = (channel * before + i) * width;
      inputs[at] = x[part + i].real();
      if (width == 2) inputs[at + 1] = x[part + i].imag();
    }
    const ComplexFft<float> fft(length);
    fft.forward(x.data());
    const auto n = static_cast<std::ptrdiff_t>(length);
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const std::ptrdiff_t bin = 2 * k < n ? k : k - n;
      const double f =
          recording.carrier + static_cast<double>(bin) * recording.sample_rate / double(n);
      // Real samples have the conjugate at −f.
      const std::complex<double> h =
          width == 1 && f < 0.0 ? std::conj(response(channel, -f)) : response(channel, f);
      const double late =
          -2.0 * pi * static_cast<double>(bin) * static_cast<double>(half) / static_cast<double>(n);
      x[static_cast<std::size_t>(k)] *=
          std::complex<float>(h * std::polar(1.0 / static_cast<double>(n), late));
    }
    fft.inverse(x.data());
    for (std::size_t i = 0; i < part; ++i) {
      row[i * width] = x[before + i].real();
      if (width == 2) row[i * width + 1] = x[before + i].imag();
    }
  });
  carried = std::move(inputs);
}

void ReceiverElectronics::convert(std::span<float> samples, const Recording& recording) const {
  const std::size_t row = recording.samples * recording.components();
  in_parallel(channels_.size(), [&](std::size_t channel) {
    if (!channels_[channel].converter) return;
    const auto& [bits, full_scale] = *channels_[channel].converter;
    const double step = std::ldexp(full_scale, 1 - bits);  // 2·full scale / 2^bits
    const double lowest = -std::ldexp(1.0, bits - 1), highest = std::ldexp(1.0, bits - 1) - 1.0;
    for (float& p : samples.subspan(channel * row, row))
      p = static_cast<float>(step * std::clamp(std::round(double{p} / step), lowest, highest));
  });
}

}  // namespace asdic::detail
