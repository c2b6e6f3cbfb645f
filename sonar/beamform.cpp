#include "sonar/beamform.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/error.h"
#include "raytrace/parallel.h"
#include "sonar/fft.h"

namespace asdic {
namespace {

void check(const Baseband& baseband, std::span<const Vec3> phones, double sound_speed,
           std::span<const double> weights) {
  const std::string channels = std::to_string(baseband.channels) + ", one for each channel";
  if (phones.size() != baseband.channels)
    throw InputError(
        {.where = "phones", .got = std::to_string(phones.size()), .expected = channels});
  if (!weights.empty() && weights.size() != baseband.channels)
    throw InputError(
        {.where = "weights", .got = std::to_string(weights.size()), .expected = channels});
  if (!(sound_speed > 0.0))
    throw InputError({.where = "sound_speed",
                      .got = std::to_string(sound_speed) + " m/s",
                      .expected = "a speed above 0 m/s"});
}

}  // namespace

std::size_t BeamPower::loudest(double from, double to) const noexcept {
  const auto index = [&](double t) {
    return static_cast<std::size_t>(
        std::clamp((t - start) * sample_rate, 0.0, static_cast<double>(samples)));
  };
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t b = 0; b < beams; ++b) {
    const auto row = beam(b);
    double energy = 0.0;
    for (std::size_t i = index(from); i < index(to); ++i) energy += static_cast<double>(row[i]);
    if (energy > most) {
      most = energy;
      best = b;
    }
  }
  return best;
}

Vec3 look_direction(double bearing, double elevation) noexcept {
  return {std::sin(bearing) * std::cos(elevation), std::cos(bearing) * std::cos(elevation),
          -std::sin(elevation)};
}

BeamPower beamform(const Baseband& baseband, std::span<const Vec3> phones,
                   std::span<const Vec3> looks, double sound_speed,
                   std::span<const double> weights) {
  check(baseband, phones, sound_speed, weights);
  const std::size_t n = baseband.samples, channels = baseband.channels;
  std::vector<double> shading(weights.begin(), weights.end());
  if (shading.empty()) shading.assign(channels, 1.0);
  const double sum = std::accumulate(shading.begin(), shading.end(), 0.0);

  const ComplexFft<float> fft(n);
  const std::size_t stride = FftBuffer<std::complex<float>>::row_stride(n);
  FftBuffer<std::complex<float>> spectra(channels * stride);
  in_parallel(channels, [&](std::size_t c) {
    std::complex<float>* row = spectra.data() + c * stride;
    std::copy_n(baseband.channel(c).data(), n, row);
    fft.forward(row);
  });

  BeamPower result{.sample_rate = baseband.sample_rate,
                   .start = baseband.start,
                   .beams = looks.size(),
                   .samples = baseband.recorded,
                   .power = {}};
  result.power.resize(looks.size() * result.samples);
  tbb::enumerable_thread_specific<FftBuffer<std::complex<float>>> workspaces;
  in_parallel(looks.size(), [&](std::size_t b) {
    auto& beam = workspaces.local();
    beam.reserve(n);
    std::fill_n(beam.data(), n, 0.0F);
    const double bin = baseband.sample_rate / static_cast<double>(n);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::complex<float>* row = spectra.data() + c * stride;
      const double delay = looks[b].dot(phones[c]) / sound_speed;
      const double weight = shading[c] / (sum * static_cast<double>(n));
      // e^{−i2π(f_c + f)·delay} over the bins: a rotation by a constant step, in double, restarted
      // at the negative frequencies.
      const std::complex<double> step = std::polar(1.0, -2.0 * pi * bin * delay);
      const auto steer = [&](std::size_t first, std::size_t last, double frequency) {
        std::complex<double> turn =
            std::polar(weight, -2.0 * pi * (baseband.carrier + frequency) * delay);
        for (std::size_t k = first; k < last; ++k) {
          beam[k] += std::complex<float>(turn) * row[k];
          turn *= step;
        }
      };
      steer(0, (n + 1) / 2, 0.0);
      const auto half = n / 2;
      steer((n + 1) / 2, n, -bin * static_cast<double>(half));
    }
    fft.inverse(beam.data());
    for (std::size_t i = 0; i < result.samples; ++i)
      result.power[b * result.samples + i] = std::norm(beam[i]);
  });
  return result;
}

}  // namespace asdic
