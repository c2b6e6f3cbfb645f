#include "processing/listening_band.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

constexpr double edge = 0.1;      // of the width, on either side
constexpr double ringing = 60.0;  // of the edges, over the width [1]

/// The bins of the padded record that are kept, and where they go.
struct BandPlan {
  std::size_t padded = 0;              // samples of the transform of the record
  double spacing = 0.0;                // of its bins [Hz]
  std::ptrdiff_t centre = 0;           // bin that becomes frequency 0
  std::ptrdiff_t first = 0, last = 0;  // bins kept, counted from `centre`
  std::vector<float> gains;            // [last − first + 1] of the filter
  std::size_t length = 0;              // of the envelope's transform

  /// \param origin  frequency of bin 0 [Hz]   \param lowest, highest  that the record holds [Hz]
  BandPlan(std::size_t samples, double rate, double origin, double lowest, double highest,
           const ListeningBand& band, double silence) {
    const auto fault = [](const std::string& got, const std::string& expected) {
      return InputError({.where = "band", .got = got, .expected = expected});
    };
    if (!(band.width > 0.0) || !std::isfinite(band.width))
      throw fault(std::to_string(band.width) + " Hz", "a width above 0 Hz");
    if (!(band.centre > lowest && band.centre < highest))
      throw fault("a centre of " + std::to_string(band.centre) + " Hz",
                  "one between " + std::to_string(lowest) + " and " + std::to_string(highest) +
                      " Hz, what the record holds");
    const double quiet = silence + ringing / band.width;
    padded = fast_fft_length(samples + static_cast<std::size_t>(std::ceil(quiet * rate)));
    spacing = rate / static_cast<double>(padded);
    centre = std::llround((band.centre - origin) / spacing);
    const double reach = (0.5 + edge) * band.width;
    const auto bin = [&](double frequency) {
      return static_cast<std::ptrdiff_t>(std::floor((frequency - origin) / spacing));
    };
    first = std::max(bin(band.centre - reach) + 1, bin(lowest) + 1) - centre;
    last = std::min(bin(band.centre + reach), bin(highest) - 1) - centre;
    for (std::ptrdiff_t k = first; k <= last; ++k) {
      const double f = origin + static_cast<double>(k + centre) * spacing - band.centre;
      const double x = std::clamp((std::abs(f) / band.width - 0.5) / edge, 0.0, 1.0);
      gains.push_back(static_cast<float>(0.5 + 0.5 * std::cos(pi * x)));
    }
    length = fast_fft_length(static_cast<std::size_t>(std::ceil(2.0 * band.width / spacing)));
    length = std::max(length, fast_fft_length(gains.size() + 1));
  }

  [[nodiscard]] Baseband empty(std::size_t channels, std::size_t samples, double rate,
                               double origin, double start) const {
    Baseband result;
    result.carrier = origin + static_cast<double>(centre) * spacing;
    result.sample_rate = static_cast<double>(length) * spacing;
    result.start = start;
    result.channels = channels;
    result.samples = length;
    const double recorded = static_cast<double>(samples) / rate * result.sample_rate;
    result.recorded = std::min(length, static_cast<std::size_t>(std::ceil(recorded)));
    result.values.resize(channels * length);
    return result;
  }

  /// One phone: the kept bins of its spectrum to its envelope.
  template <class BinAt>
  void envelope(const BinAt& bin_at, std::complex<float> rotation, double scale,
                FftBuffer<std::complex<float>>& work, std::complex<float>* out) const {
    std::fill_n(work.data(), length, 0.0F);
    const auto n = static_cast<std::ptrdiff_t>(length);
    for (std::ptrdiff_t k = first; k <= last; ++k)
      work[static_cast<std::size_t>(k < 0 ? k + n : k)] =
          bin_at(k + centre) *
          (static_cast<float>(scale) * gains[static_cast<std::size_t>(k - first)]);
    ComplexFft<float>(length).inverse(work.data());
    for (std::size_t i = 0; i < length; ++i) out[i] = work[i] * rotation;
  }
};

/// The transform counts its phase from the first sample, the carrier from t = 0.
std::complex<float> carrier_rotation(const Baseband& b, double recorded_carrier, double start) {
  return std::complex<float>(std::polar(
      1.0, std::remainder(-2.0 * pi * (b.carrier - recorded_carrier) * start, 2.0 * pi)));
}

}  // namespace

double ListeningBand::gain(double frequency) const noexcept {
  const double x = std::clamp((std::abs(frequency - centre) / width - 0.5) / edge, 0.0, 1.0);
  return 0.5 + 0.5 * std::cos(pi * x);
}

Baseband to_baseband(std::span<const float> pressure, std::size_t channels, double sample_rate,
                     double start, const ListeningBand& band, double silence) {
  const std::size_t samples = channels == 0 ? 0 : pressure.size() / channels;
  const BandPlan plan(samples, sample_rate, 0.0, 0.0, 0.5 * sample_rate, band, silence);
  Baseband result = plan.empty(channels, samples, sample_rate, 0.0, start);
  const RealFft<float> fft(plan.padded);
  static_cast<void>(ComplexFft<float>(plan.length));  // made before the tasks begin
  const std::complex<float> rotation = carrier_rotation(result, 0.0, start);
  struct Work {
    FftBuffer<float> real;
    FftBuffer<std::complex<float>> bins, envelope;
  };
  tbb::enumerable_thread_specific<Work> works;
  in_parallel(channels, [&](std::size_t c) {
    Work& work = works.local();
    work.real.reserve(plan.padded);
    work.bins.reserve(fft.bins());
    work.envelope.reserve(plan.length);
    std::copy_n(pressure.data() + c * samples, samples, work.real.data());
    std::fill(work.real.data() + samples, work.real.data() + plan.padded, 0.0F);
    fft.forward(work.real.data(), work.bins.data());
    plan.envelope([&](std::ptrdiff_t k) { return work.bins[static_cast<std::size_t>(k)]; },
                  rotation, 2.0 / static_cast<double>(plan.padded), work.envelope,
                  result.values.data() + c * plan.length);
  });
  return result;
}

Baseband to_baseband(std::span<const std::complex<float>> envelope, std::size_t channels,
                     double sample_rate, double carrier, double start, const ListeningBand& band,
                     double silence) {
  const std::size_t samples = channels == 0 ? 0 : envelope.size() / channels;
  const BandPlan plan(samples, sample_rate, carrier, carrier - 0.5 * sample_rate,
                      carrier + 0.5 * sample_rate, band, silence);
  Baseband result = plan.empty(channels, samples, sample_rate, carrier, start);
  const ComplexFft<float> fft(plan.padded);
  static_cast<void>(ComplexFft<float>(plan.length));
  const std::complex<float> rotation = carrier_rotation(result, carrier, start);
  struct Work {
    FftBuffer<std::complex<float>> bins, envelope;
  };
  tbb::enumerable_thread_specific<Work> works;
  in_parallel(channels, [&](std::size_t c) {
    Work& work = works.local();
    work.bins.reserve(plan.padded);
    work.envelope.reserve(plan.length);
    std::copy_n(envelope.data() + c * samples, samples, work.bins.data());
    std::fill(work.bins.data() + samples, work.bins.data() + plan.padded, 0.0F);
    fft.forward(work.bins.data());
    const auto n = static_cast<std::ptrdiff_t>(plan.padded);
    plan.envelope(
        [&](std::ptrdiff_t k) { return work.bins[static_cast<std::size_t>(k < 0 ? k + n : k)]; },
        rotation, 1.0 / static_cast<double>(plan.padded), work.envelope,
        result.values.data() + c * plan.length);
  });
  return result;
}

}  // namespace asdic::detail
