#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/units.h"
#include "sonar/interpolation_taps.h"
#include "sonar/synthesis.h"
#include "sonar/synthesis_plan.h"

namespace asdic {
namespace {

/// Of a signal 1.35 times oversampled (DelayKernel), 24 taps under a window of −97 dB:
/// A = 2.285·23·2π(1 − 1/1.35) + 8, β = 0.1102(A − 8.7).
using Taps = InterpolationTaps<float, 24>;
constexpr double kaiser_beta = 9.73;
static_assert(DelayKernel::oversampling >= 1.35);

/// Real taps, each twice: as they multiply interleaved complex samples.
using TwiceEach = Eigen::Array<float, 2 * Taps::taps, 1>;

/// Σ w_k·x_k in lanes of four samples. \param samples  [taps] real and imaginary part in turn
std::complex<float> weighted(const float* samples, const TwiceEach& weights) {
  using Lanes = Eigen::Array<float, 8, 1>;
  static_assert(2 * Taps::taps % 8 == 0);
  Lanes sum = Lanes::Zero();
  for (int k = 0; k < 2 * Taps::taps; k += 8)
    sum += Eigen::Map<const Lanes>(samples + k) * weights.segment<8>(k);
  const Eigen::Array4f half = sum.head<4>() + sum.tail<4>();
  return {half[0] + half[2], half[1] + half[3]};
}

/// Samples of the record that are interpolated at one time: their taps stay in the cache.
constexpr std::size_t block = 64;

/// Where the samples of a block lie between those of the baseband, and what turns them.
struct Places {
  std::array<std::ptrdiff_t, block> first;  // of the samples under the taps
  std::array<TwiceEach, block> weights;
  std::array<std::complex<float>, block> turn;
};

/// Whether a row has anything in its samples from `first` to `last`, which go on periodically.
class Silence {
 public:
  explicit Silence(const Baseband& baseband)
      : blocks_((baseband.samples + length - 1) / length), heard_(blocks_, false) {
    for (std::size_t n = 0; n < baseband.channels; ++n) {
      const auto row = baseband.channel(n);
      for (std::size_t b = 0; b < blocks_; ++b) {
        const auto part = row.subspan(b * length, std::min(length, row.size() - b * length));
        heard_[b] = heard_[b] || !all_zero(part);
      }
    }
  }
  [[nodiscard]] bool between(std::ptrdiff_t first, std::ptrdiff_t last, std::size_t period) const {
    const auto n = static_cast<std::ptrdiff_t>(period);
    for (std::ptrdiff_t i = first; i <= last; ++i)
      if (heard_[static_cast<std::size_t>((i % n + n) % n) / length]) return false;
    return true;
  }

 private:
  /// All bits but the signs, in lanes.
  [[nodiscard]] static bool all_zero(std::span<const std::complex<float>> part) {
    const float* x = reinterpret_cast<const float*>(part.data());
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 2 * part.size(); ++i) bits |= std::bit_cast<std::uint32_t>(x[i]);
    return (bits & 0x7FFFFFFFU) == 0;
  }

  static constexpr std::size_t length = 64;
  std::size_t blocks_;
  std::vector<bool> heard_;
};

}  // namespace

/// b(t) = (1/L) Σ_k X_k e^{i2πk(t − t₀)/P} about the synthesis' carrier; what leaves the new band
/// is left out, as an anti-alias filter would.
void Synthesizer::add_by_fft(const Baseband& baseband, double scale,
                             std::span<float> samples) const {
  const Plan& plan = *plan_;
  const Recording& recording = plan.recording;
  const double period = static_cast<double>(plan.passband_length) / recording.sample_rate;
  const auto new_carrier_bin = static_cast<std::ptrdiff_t>(std::round(recording.carrier * period));
  const double beside = recording.carrier - static_cast<double>(new_carrier_bin) / period;
  const double cycles =
      (plan.carrier - recording.carrier) * recording.start - recording.carrier * epoch_;
  const std::complex<double> turn = std::polar(scale / static_cast<double>(plan.length),
                                               2.0 * pi * (cycles - std::round(cycles)));
  const ComplexFft<float> fft(plan.length), fine(plan.passband_length);
  const auto all = static_cast<std::ptrdiff_t>(plan.passband_length);
  struct Workspace {
    FftBuffer<std::complex<float>> baseband, samples;
  };
  tbb::enumerable_thread_specific<Workspace> workspaces;
  tbb::parallel_for(std::size_t{0}, baseband.channels, [&](std::size_t channel) {
    Workspace& scratch = workspaces.local();
    scratch.baseband.reserve(plan.length);
    scratch.samples.reserve(plan.passband_length);
    std::copy_n(baseband.channel(channel).data(), plan.length, scratch.baseband.data());
    fft.forward(scratch.baseband.data());
    std::fill_n(scratch.samples.data(), plan.passband_length, 0.0F);
    for (std::ptrdiff_t k = -plan.highest_bin; k <= plan.highest_bin; ++k) {
      const std::ptrdiff_t place = plan.carrier_bin + k - new_carrier_bin;
      if (2 * std::abs(place) >= all) continue;
      const auto from =
          static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(plan.length) : k);
      scratch.samples[static_cast<std::size_t>(place < 0 ? place + all : place)] =
          std::complex<float>(turn) * scratch.baseband[from];
    }
    fine.inverse(scratch.samples.data());
    float* out = samples.data() + channel * recording.samples * 2;
    for (std::size_t i = 0; i < recording.samples; ++i) {
      const double t = static_cast<double>(i) / recording.sample_rate;
      const std::complex<float> value =
          scratch.samples[i] * std::complex<float>(std::polar(1.0, -2.0 * pi * beside * t));
      out[2 * i] += value.real();
      out[2 * i + 1] += value.imag();
    }
  });
}

/// The same out of the baseband's samples, where its whole band lies within the recorded one.
void Synthesizer::add_by_interpolation(const Baseband& baseband, double scale,
                                       std::span<float> samples) const {
  const Plan& plan = *plan_;
  static const Taps taps(kaiser_beta);
  const Recording& recording = plan.recording;
  const auto period = static_cast<std::ptrdiff_t>(plan.length);
  const double beside = plan.carrier - recording.carrier;
  const double from_start = beside * recording.start - recording.carrier * epoch_;
  const double step = plan.rate / recording.sample_rate;
  const std::complex<double> turn_step = std::polar(1.0, 2.0 * pi * beside / recording.sample_rate);
  const Silence silence(baseband);
  const auto add = [&](std::size_t begin) {
    const std::size_t count = std::min(block, recording.samples - begin);
    const double low = static_cast<double>(begin) * step;
    const auto lowest = static_cast<std::ptrdiff_t>(low) - Taps::before;
    const auto highest =
        static_cast<std::ptrdiff_t>(static_cast<double>(begin + count - 1) * step) - Taps::before +
        Taps::taps - 1;
    if (silence.between(lowest, highest, plan.length)) return;
    Places at;
    const double cycles = from_start + beside * static_cast<double>(begin) / recording.sample_rate;
    std::complex<double> turn = std::polar(scale, 2.0 * pi * (cycles - std::round(cycles)));
    for (std::size_t i = 0; i < count; ++i) {
      const double position = static_cast<double>(begin + i) * step;
      const double below = std::floor(position);
      at.first[i] = static_cast<std::ptrdiff_t>(below) - Taps::before;
      const Taps::Weights once = taps.at(static_cast<float>(position - below));
      for (int k = 0; k < Taps::taps; ++k)
        at.weights[i][2 * k] = at.weights[i][2 * k + 1] = once[k];
      at.turn[i] = std::complex<float>(turn);
      turn *= turn_step;
    }
    // The samples under the block's taps, wrapped around the period.
    std::vector<std::complex<float>> under(static_cast<std::size_t>(highest - lowest + 1));
    for (std::size_t n = 0; n < baseband.channels; ++n) {
      const auto row = baseband.channel(n);
      for (std::ptrdiff_t i = lowest, k = (lowest % period + period) % period; i <= highest; ++i) {
        under[static_cast<std::size_t>(i - lowest)] = row[static_cast<std::size_t>(k)];
        if (++k == period) k = 0;
      }
      float* out = samples.data() + (n * recording.samples + begin) * 2;
      for (std::size_t i = 0; i < count; ++i) {
        const std::complex<float> sum = weighted(
            reinterpret_cast<const float*>(under.data() + (at.first[i] - lowest)), at.weights[i]);
        const std::complex<float> by = at.turn[i];
        out[2 * i] += sum.real() * by.real() - sum.imag() * by.imag();
        out[2 * i + 1] += sum.real() * by.imag() + sum.imag() * by.real();
      }
    }
  };
  oneapi::tbb::parallel_for(std::size_t{0}, (recording.samples + block - 1) / block,
                            [&](std::size_t b) { add(b * block); });
}

void Synthesizer::add_complex(const Baseband& baseband, double scale,
                              std::span<float> samples) const {
  const Plan& plan = *plan_;
  const double period = static_cast<double>(plan.passband_length) / plan.recording.sample_rate;
  const double furthest = std::abs(plan.carrier - plan.recording.carrier) +
                          static_cast<double>(plan.highest_bin) / period;
  if (furthest <= 0.5 * plan.recording.sample_rate)
    add_by_interpolation(baseband, scale, samples);
  else
    add_by_fft(baseband, scale, samples);
}

}  // namespace asdic
