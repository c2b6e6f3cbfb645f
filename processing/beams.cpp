#include "processing/beams.h"

#include <cmath>
#include <string>

#include "core/error.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/complex_product.h"

namespace asdic::detail {

BeamSpectra channel_spectra(const Baseband& baseband) {
  BeamSpectra result{.beams = baseband.channels,
                     .bins = baseband.samples,
                     .stride = FftBuffer<std::complex<float>>::row_stride(baseband.samples),
                     .values = {}};
  result.values = FftBuffer<std::complex<float>>(result.beams * result.stride);
  const ComplexFft<float> fft(baseband.samples);
  in_parallel(baseband.channels, [&](std::size_t c) {
    std::copy_n(baseband.channel(c).data(), baseband.samples, result.beam(c));
    fft.forward(result.beam(c));
  });
  return result;
}

BeamSpectra conventional_beams(const BeamSpectra& channels, const Baseband& baseband,
                               std::span<const Vec3> phones, std::span<const Vec3> looks,
                               double sound_speed, std::span<const double> weights) {
  const auto expect = [&](const char* where, std::size_t got) {
    if (got != channels.beams)
      throw InputError({.where = where,
                        .got = std::to_string(got),
                        .expected = std::to_string(channels.beams) + ", one for each channel"});
  };
  expect("phones", phones.size());
  expect("weights", weights.size());
  BeamSpectra result{
      .beams = looks.size(), .bins = channels.bins, .stride = channels.stride, .values = {}};
  result.values = FftBuffer<std::complex<float>>(result.beams * result.stride);
  const std::size_t n = channels.bins;
  const double spacing = baseband.sample_rate / static_cast<double>(n);
  in_parallel(looks.size(), [&](std::size_t b) {
    std::complex<float>* beam = result.beam(b);
    for (std::size_t c = 0; c < channels.beams; ++c) {
      if (weights[c] == 0.0) continue;
      const std::complex<float>* row = channels.beam(c);
      const double delay = looks[b].dot(phones[c]) / sound_speed;
      // e^{−i2π(f_c + f)·delay} over the bins: rotations by a constant step, restarted every 64
      // bins so that the float recursion stays within 1e-5.
      const auto steer = [&](std::size_t first, std::size_t last, double frequency) {
        const std::complex<float> step(std::polar(1.0, -2.0 * pi * spacing * delay));
        for (std::size_t begin = first; begin < last; begin += 64) {
          const double f =
              baseband.carrier + frequency + spacing * static_cast<double>(begin - first);
          std::complex<float> rotation(
              std::polar(weights[c], std::remainder(-2.0 * pi * f * delay, 2.0 * pi)));
          const std::size_t end = std::min(begin + 64, last);
          for (std::size_t k = begin; k < end; ++k) {
            beam[k] += finite_product(rotation, row[k]);
            rotation = finite_product(rotation, step);
          }
        }
      };
      steer(0, (n + 1) / 2, 0.0);
      const auto half = n / 2;
      steer((n + 1) / 2, n, -spacing * static_cast<double>(half));
    }
  });
  return result;
}

}  // namespace asdic::detail
