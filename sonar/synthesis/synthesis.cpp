#include "sonar/synthesis/synthesis.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/synthesis/synthesis_plan.h"

namespace asdic {

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
  const std::complex<double> turn = std::polar(0.5 * scale / static_cast<double>(plan.length),
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
      const std::complex<float> half = std::complex<float>(turn) * scratch.baseband[from];
      put(plan.carrier_bin + k, half);
      put(-plan.carrier_bin - k, std::conj(half));
    }
    real_fft.inverse(scratch.bins.data(), scratch.samples.data());
    float* __restrict out = pressure.data() + channel * samples;
    const float* __restrict in = scratch.samples.data();
    for (std::size_t i = 0; i < samples; ++i) out[i] += in[i];
  });
}

}  // namespace asdic
