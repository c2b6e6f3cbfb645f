#include "sonar/synthesis/synthesis.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/simd.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/tap_sums.h"
#include "sonar/synthesis/place_weights.h"
#include "sonar/synthesis/synthesis_plan.h"

namespace asdic::detail {

Synthesizer::Synthesizer(const Pulse& pulse, const Recording& recording, double max_doppler,
                         const std::function<double(double)>& filter)
    : Synthesizer(pulse, recording, max_doppler, std::vector{filter}) {}
Synthesizer::Synthesizer(const Pulse& pulse, const Recording& recording, double max_doppler,
                         const std::vector<std::function<double(double)>>& filters)
    : plan_(std::make_shared<const Plan>(pulse, recording, max_doppler, filters)),
      epoch_(recording.epoch) {}
Synthesizer::Synthesizer(const Pulse& pulse, const Recording& recording, double max_doppler,
                         PropagationMemory& memory)
    : plan_(Plan::recalled(pulse, recording, max_doppler, memory)),
      epoch_(recording.epoch),
      memory_(&memory) {}
double Synthesizer::half_band() const noexcept { return plan_->pulses.front().half_band(); }
Synthesizer::~Synthesizer() = default;
Synthesizer::Synthesizer(Synthesizer&&) noexcept = default;

Baseband Synthesizer::silence(std::size_t phones, std::vector<std::complex<float>> memory) const {
  return silence_of(phones, plan_->length, DelayKernel::oversampling, std::move(memory));
}

/// \param length  samples of the synthesis' period
Baseband Synthesizer::silence_of(std::size_t phones, std::size_t length, double oversampling,
                                 std::vector<std::complex<float>> memory) const {
  const Plan& plan = *plan_;
  const double rate = plan.rate * static_cast<double>(length) / static_cast<double>(plan.length);
  const double record =
      static_cast<double>(plan.recording.samples) / plan.recording.sample_rate;  // [s]
  Baseband result{.carrier = plan.carrier,
                  .sample_rate = rate,
                  .start = plan.recording.start,
                  .channels = phones,
                  .samples = length,
                  .recorded = std::min(length, static_cast<std::size_t>(record * rate) + 1),
                  .oversampling = oversampling,
                  .values = std::move(memory)};
  result.values.assign(phones * length, 0.0F);
  return result;
}

void append_channels(Baseband& all, Baseband&& more) {
  if (all.channels == 0) {
    all = std::move(more);
    return;
  }
  assert(all.samples == more.samples && all.carrier == more.carrier && all.start == more.start);
  all.values.insert(all.values.end(), more.values.begin(), more.values.end());
  all.channels += more.channels;
}

void Synthesizer::add_samples(const Baseband& baseband, double scale,
                              std::span<float> samples) const {
  const Recording& recording = plan_->recording;
  assert(samples.size() == baseband.channels * recording.samples * recording.components());
  if (recording.is_complex())
    add_complex(baseband, scale, samples);
  else
    add_passband(baseband, scale, samples);
}

void Synthesizer::add_passband(const Baseband& baseband, double scale,
                               std::span<float> pressure) const {
  const Plan& plan = *plan_;
  const std::size_t samples = plan.recording.samples;
  assert(baseband.samples == plan.length && baseband.carrier == plan.carrier);
  assert(pressure.size() == baseband.channels * samples);
  struct PassbandScratch {
    FftBuffer<std::complex<float>> baseband, bins;
    FftBuffer<float> samples;
  };
  const ComplexFft<float> fft(plan.length);
  const RealFft<float> real_fft(plan.passband_length);
  tbb::enumerable_thread_specific<PassbandScratch> workspaces;
  // e^{i2πf_c t} from the record's start, and the FFT's scale; Re z = (z + z*)/2 gives the half.
  const double cycles = plan.carrier * plan.recording.start;
  const std::complex<double> rotation = std::polar(0.5 * scale / static_cast<double>(plan.length),
                                                   2.0 * pi * (cycles - std::round(cycles)));
  const auto all = static_cast<std::ptrdiff_t>(plan.passband_length);

  in_parallel(baseband.channels, [&](std::size_t channel) {
    PassbandScratch& scratch = workspaces.local();
    scratch.baseband.reserve(plan.length);
    scratch.bins.reserve(real_fft.bins());
    scratch.samples.reserve(plan.passband_length);
    std::copy_n(baseband.channel(channel).data(), plan.length, scratch.baseband.data());
    fft.forward(scratch.baseband.data());
    std::fill_n(scratch.bins.data(), real_fft.bins(), 0.0F);
    const auto put = [&](std::ptrdiff_t k, std::complex<float> value) {
      k = (k % all + all) % all;  // a bin beyond half the rate aliases, as sampling would
      if (k < static_cast<std::ptrdiff_t>(real_fft.bins()))
        scratch.bins[static_cast<std::size_t>(k)] += value;
    };
    for (std::ptrdiff_t k = -plan.highest_bin; k <= plan.highest_bin; ++k) {
      const std::size_t from =
          static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(plan.length) : k);
      const std::complex<float> half = std::complex<float>(rotation) * scratch.baseband[from];
      put(plan.carrier_bin + k, half);
      put(-plan.carrier_bin - k, std::conj(half));
    }
    real_fft.inverse(scratch.bins.data(), scratch.samples.data());
    float* __restrict out = pressure.data() + channel * samples;
    const float* __restrict in = scratch.samples.data();
    for (std::size_t i = 0; i < samples; ++i) out[i] += in[i];
  });
}

namespace {

/// Samples of the record that are interpolated at one time: their taps stay in the cache.
constexpr std::size_t block = 128;

/// Where the samples of a block lie between those of the baseband, and what turns them.
struct Places {
  std::size_t count = 0;
  std::ptrdiff_t lowest = 0, highest = 0;   // of the baseband's samples under all taps
  std::array<std::size_t, block> first;     // of those under a sample's taps, after the lowest
  std::array<const float*, block> weights;  // [taps] each
  std::array<std::complex<float>, block> rotation;
};

/// Complex samples of four phones, and the same moved about whole.
using Four = Lanes<float, 8>;
using Whole = Lanes<double, 4>;

/// Adds four samples of four phones to their rows. \param sums  [samples × stride]
void add_transposed(const float* sums, std::size_t stride, std::size_t phones, float* out,
                    std::size_t row) noexcept {
  std::array<Whole, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = load_lanes<Whole>(sums + i * stride);
  transpose(x);
  for (std::size_t n = 0; n < phones; ++n) {
    float* to = out + n * row;
    store_lanes(load_lanes<Four>(to) + load_lanes<Four>(&x[n]), to);
  }
}

/// Adds a block's samples of some phones, side by side in lanes: Σ w_k·x_k, turned.
/// \param fours  of phones side by side, of which `phones` from `channel` on are there
/// \param samples  of the record, from the block's first on   \param row  from phone to phone
template <std::size_t fours, std::size_t taps>
void interpolate(const Baseband& baseband, std::size_t channel, std::size_t phones,
                 const Places& at, float* samples, std::size_t row) {
  constexpr std::size_t stride = 8 * fours;
  const auto period = static_cast<std::ptrdiff_t>(baseband.samples);
  // [samples × phones], wrapped around the period; zero where there is no phone
  const auto places = static_cast<std::size_t>(at.highest - at.lowest + 1);
  const auto under = std::make_unique_for_overwrite<float[]>(places * stride);
  if (phones < 4 * fours) std::fill_n(under.get(), places * stride, 0.0F);
  for (std::size_t n = 0; n < phones; ++n) {
    const auto x = baseband.channel(channel + n);
    std::ptrdiff_t k = (at.lowest % period + period) % period;
    float* to = under.get() + 2 * n;
    for (std::size_t i = 0; i < places; ++i, to += stride) {
      to[0] = x[static_cast<std::size_t>(k)].real();
      to[1] = x[static_cast<std::size_t>(k)].imag();
      if (++k == period) k = 0;
    }
  }
  std::array<float, block * stride> sums;
  for (std::size_t i = 0; i < at.count; ++i) {
    const float* from = under.get() + at.first[i] * stride;
    const auto sum = gather<Four, taps, fours>(
        [&](std::size_t k) { return at.weights[i][k]; },
        [&](std::size_t k, std::size_t q) { return load_lanes<Four>(from + k * stride + 8 * q); });
    const float c = at.rotation[i].real(), s = at.rotation[i].imag();
    const Four across = {-s, s, -s, s, -s, s, -s, s};
    for (std::size_t q = 0; q < fours; ++q) {
      const Four swapped = __builtin_shufflevector(sum[q], sum[q], 1, 0, 3, 2, 5, 4, 7, 6);
      store_lanes(sum[q] * c + swapped * across, &sums[i * stride + 8 * q]);
    }
  }
  for (std::size_t n = 0; n < phones; n += 4) {
    const std::size_t there = std::min<std::size_t>(4, phones - n);
    float* const out = samples + n * row;
    std::size_t i = 0;
    for (; i + 4 <= at.count; i += 4)
      add_transposed(&sums[i * stride + 2 * n], stride, there, out + 2 * i, row);
    for (; i < at.count; ++i)
      for (std::size_t k = 0; k < 2 * there; ++k)
        out[k / 2 * row + 2 * i + k % 2] += sums[i * stride + 2 * n + k];
  }
}

/// Whether a row has anything in its samples from `first` to `last`, which go on periodically.
class Silence {
 public:
  explicit Silence(const Baseband& baseband)
      : blocks_((baseband.samples + length - 1) / length), received_(blocks_, false) {
    for (std::size_t n = 0; n < baseband.channels; ++n) {
      const auto row = baseband.channel(n);
      for (std::size_t b = 0; b < blocks_; ++b) {
        const auto part = row.subspan(b * length, std::min(length, row.size() - b * length));
        received_[b] = received_[b] || !all_zero(part);
      }
    }
  }
  [[nodiscard]] bool between(std::ptrdiff_t first, std::ptrdiff_t last, std::size_t period) const {
    const auto n = static_cast<std::ptrdiff_t>(period);
    for (std::ptrdiff_t i = first; i <= last; ++i)
      if (received_[static_cast<std::size_t>((i % n + n) % n) / length]) return false;
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
  std::vector<bool> received_;
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
  const std::complex<double> rotation = std::polar(scale / static_cast<double>(plan.length),
                                                   2.0 * pi * (cycles - std::round(cycles)));
  const ComplexFft<float> fft(plan.length), fine(plan.passband_length);
  const auto all = static_cast<std::ptrdiff_t>(plan.passband_length);
  struct Workspace {
    FftBuffer<std::complex<float>> baseband, samples;
  };
  tbb::enumerable_thread_specific<Workspace> workspaces;
  in_parallel(baseband.channels, [&](std::size_t channel) {
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
          std::complex<float>(rotation) * scratch.baseband[from];
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

namespace {

/// Adds what is between a baseband's samples to the record's. \param to  samples of its period
template <int n_taps>
void interpolate_all(const Baseband& baseband, const Recording& recording, double epoch,
                     std::size_t to, double scale, std::span<float> samples) {
  const PlaceWeights<n_taps> weights(baseband.samples, to);
  const double beside = baseband.carrier - recording.carrier;
  const double from_start = beside * recording.start - recording.carrier * epoch;
  const std::complex<double> rotation_step =
      std::polar(1.0, 2.0 * pi * beside / recording.sample_rate);
  const Silence silence(baseband);
  const auto add = [&](std::size_t begin) {
    Places at;
    std::array<typename PlaceWeights<n_taps>::Weights, block> own;
    at.count = std::min(block, recording.samples - begin);
    const auto first = weights.place(begin), last = weights.place(begin + at.count - 1);
    at.lowest = static_cast<std::ptrdiff_t>(first.below) - weights.before;
    at.highest = static_cast<std::ptrdiff_t>(last.below) - weights.before + n_taps - 1;
    if (silence.between(at.lowest, at.highest, baseband.samples)) return;
    const double cycles = from_start + beside * static_cast<double>(begin) / recording.sample_rate;
    std::complex<double> rotation = std::polar(scale, 2.0 * pi * (cycles - std::round(cycles)));
    auto place = first;
    for (std::size_t i = 0; i < at.count; ++i) {
      at.first[i] = place.below - first.below;
      at.weights[i] = weights.at(place, own[i]);
      at.rotation[i] = std::complex<float>(rotation);
      rotation *= rotation_step;
      weights.next(place);
    }
    const std::size_t row = 2 * recording.samples;
    for (std::size_t n = 0; n < baseband.channels;) {
      const std::size_t left = baseband.channels - n, phones = std::min<std::size_t>(left, 16);
      const auto part = phones > 8   ? interpolate<4, n_taps>
                        : phones > 4 ? interpolate<2, n_taps>
                                     : interpolate<1, n_taps>;
      part(baseband, n, phones, at, samples.data() + n * row + 2 * begin, row);
      n += phones;
    }
  };
  in_parallel((recording.samples + block - 1) / block, [&](std::size_t b) { add(b * block); });
}

}  // namespace

/// The same out of the baseband's samples, where its whole band lies within the recorded one.
void Synthesizer::add_by_interpolation(const Baseband& baseband, double scale,
                                       std::span<float> samples) const {
  const auto add =
      baseband.oversampling < oversampling_for_12_taps ? interpolate_all<24> : interpolate_all<12>;
  add(baseband, plan_->recording, epoch_, plan_->passband_length, scale, samples);
}

/// Whether the whole band of the synthesis lies within the recorded one.
bool Synthesizer::interpolates() const noexcept {
  const Plan& plan = *plan_;
  if (!plan.recording.is_complex()) return false;
  const double period = static_cast<double>(plan.passband_length) / plan.recording.sample_rate;
  const double furthest = std::abs(plan.carrier - plan.recording.carrier) +
                          static_cast<double>(plan.highest_bin) / period;
  return furthest <= 0.5 * plan.recording.sample_rate;
}

void Synthesizer::add_complex(const Baseband& baseband, double scale,
                              std::span<float> samples) const {
  if (interpolates())
    add_by_interpolation(baseband, scale, samples);
  else
    add_by_fft(baseband, scale, samples);
}

}  // namespace asdic::detail
