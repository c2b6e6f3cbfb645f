#include "sonar/synthesis/synthesis_plan.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/propagation_memory.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

std::string hertz(double value) {
  std::ostringstream text;
  text << value << " Hz";
  return text.str();
}

void check(const Pulse& pulse, const Recording& recording, double max_doppler) {
  if (!(max_doppler >= 0.0 && max_doppler < 0.5))
    throw InputError({.where = "max_doppler",
                      .got = std::to_string(max_doppler),
                      .expected = "a share of the speed of sound between 0 and 0.5"});
  const double highest =
      (pulse.centre_frequency() + 0.5 * pulse.bandwidth_40db()) * (1.0 + max_doppler);
  if (recording.is_complex()) {
    const double lowest =
        (pulse.centre_frequency() - 0.5 * pulse.bandwidth_40db()) * (1.0 - max_doppler);
    const double half =
        std::max(std::abs(highest - recording.carrier), std::abs(lowest - recording.carrier));
    if (!(recording.sample_rate >= 2.0 * half && std::isfinite(recording.sample_rate)))
      throw InputError({.where = "baseband_rate",
                        .got = hertz(recording.sample_rate),
                        .expected = "at least " + hertz(2.0 * half) +
                                    ", twice the furthest that the pulse's band (−40 dB, Doppler "
                                    "included) reaches from the carrier"});
  } else if (!(recording.sample_rate > 2.0 * highest && std::isfinite(recording.sample_rate)))
    throw InputError({.where = "sample_rate",
                      .got = hertz(recording.sample_rate),
                      .expected = "more than " + hertz(2.0 * highest) +
                                  ", twice the highest frequency of the pulse (−40 dB, Doppler "
                                  "included)"});
  if (recording.samples == 0)
    throw InputError({.where = "recording.samples", .got = "0", .expected = "at least 1"});
}

/// The pulse through every filter. If there are several, the unfiltered pulse follows, for which
/// everything that they share is computed.
std::vector<BandLimitedPulse> responses(const Pulse& sent, const Recording& record,
                                        double max_doppler,
                                        std::vector<std::function<double(double)>> filters) {
  check(sent, record, max_doppler);
  if (filters.size() > 1) filters.emplace_back();
  std::vector<BandLimitedPulse> pulses;
  for (const auto& filter : filters)
    pulses.push_back(recorded_pulse(sent, record, max_doppler, filter));
  return pulses;
}

std::uint64_t next_identity() {
  static std::atomic<std::uint64_t> next{0};
  return next++;
}

/// Samples of a record to half a pulse, or to 64 times what its band resolves if that is less.
std::size_t unit_of(const Pulse& pulse, const Recording& record) {
  const double most =
      record.sample_rate * std::min(0.5 * pulse.duration(), 64.0 / pulse.bandwidth_40db());
  return std::bit_floor(std::max<std::size_t>(2, static_cast<std::size_t>(most)));
}

Recording without_epoch(Recording recording) {
  recording.epoch = 0.0;
  return recording;
}

/// All that a plan depends on; a file's name and the epoch change nothing.
ExactKey key_of(const PulseSettings& pulse, const Recording& record, double max_doppler) {
  // Every member by name: one more does not compile until it is here.
  const auto& [rate, start, samples, carrier, epoch] = record;
  return ExactKey(Kept::synthesis, 0, pulse, rate, start, samples, carrier, max_doppler);
}

}  // namespace

std::shared_ptr<const Synthesizer::Plan> Synthesizer::Plan::recalled(const Pulse& sent,
                                                                     const Recording& record,
                                                                     double doppler,
                                                                     PropagationMemory& memory) {
  return memory.remember(
      key_of(sent.settings(), record, doppler),
      [&] {
        return std::make_shared<Plan>(sent, record, doppler,
                                      std::vector{std::function<double(double)>()});
      },
      [](const Plan& plan) {
        // The pulse: two doubles for each of some 4·half_band samples a second; the expansion no
        // more.
        const BandLimitedPulse& pulse = plan.pulses.front();
        const double samples = 8.0 * pulse.half_band() * pulse.half_duration();
        return sizeof(Plan) + plan.deconvolution.capacity() * sizeof(float) +
               static_cast<std::size_t>(4.0 * samples) * sizeof(double);
      });
}

Synthesizer::Plan::Plan(const Pulse& sent, const Recording& record, double doppler,
                        const std::vector<std::function<double(double)>>& filters)
    : Plan(responses(sent, record, doppler, filters), sent.duration(), unit_of(sent, record),
           record, doppler) {}

Synthesizer::Plan::Plan(const BandLimitedPulse& sound, const Recording& record, double doppler)
    : Plan(std::vector{sound}, 0.0, 2, record, doppler) {}

Synthesizer::Plan::Plan(std::vector<BandLimitedPulse> sounds, double duration, std::size_t whole,
                        const Recording& record, double doppler)
    : identity(next_identity()),
      recording(without_epoch(record)),
      max_doppler(doppler),
      pulse_duration(duration),
      pulses(std::move(sounds)),
      expansion(pulses.back()),
      unit(whole) {
  if (pulses.size() > 1) pulses.pop_back();
  const BandLimitedPulse& pulse = pulses.front();
  const double longest = pulse.half_duration() / (1.0 - max_doppler);
  const double record_duration = static_cast<double>(recording.samples) / recording.sample_rate;
  // The stretched pulse's band about the carrier; the last term lets the carrier move to a bin.
  const double half_band =
      pulse.centre_frequency() * max_doppler + pulse.half_band() * (1.0 + max_doppler);
  const double least_rate = 2.0 * half_band * DelayKernel::oversampling;
  constexpr double margin = 4.0 * DelayKernel::taps;  // samples
  const double least_period = record_duration + 2.0 * longest + margin / least_rate;

  const double least_units = least_period * recording.sample_rate / static_cast<double>(unit);
  passband_length = unit * fast_fft_length(static_cast<std::size_t>(std::ceil(least_units)));
  const double period = static_cast<double>(passband_length) / recording.sample_rate;
  carrier_bin = static_cast<std::ptrdiff_t>(std::round(pulse.centre_frequency() * period));
  carrier = static_cast<double>(carrier_bin) / period;
  highest_bin = static_cast<std::ptrdiff_t>(std::ceil(half_band * period + 0.5));
  length = fast_fft_length(static_cast<std::size_t>(
      std::ceil((2.0 * static_cast<double>(highest_bin) + 1.0) * DelayKernel::oversampling)));
  rate = static_cast<double>(length) / period;
  lead = static_cast<std::size_t>(std::ceil(longest * rate)) + DelayKernel::taps;
  last_position = static_cast<double>(lead) + (record_duration + longest) * rate + 1.0;
  deconvolution = deconvolution_of(length, highest_bin);
}

Synthesizer::Plan::Clock Synthesizer::Plan::clock(double least) const {
  // The filter of a pulse that fills the recorded band depends on the record's length as well.
  constexpr double cut = 0.7;
  if (recording.is_complex() && least > cut * recording.sample_rate)
    least = std::max(least, recording.sample_rate);
  const double units = recording.sample_rate / static_cast<double>(unit);  // a second
  const std::size_t to_a_unit = fast_fft_length(static_cast<std::size_t>(std::ceil(least / units)));
  return {.rate = static_cast<double>(to_a_unit) * units,
          .length = to_a_unit * (passband_length / unit)};
}

std::vector<float> Synthesizer::Plan::deconvolution_of(std::size_t samples,
                                                       std::ptrdiff_t highest) const {
  std::vector<float> found(static_cast<std::size_t>(2 * highest + 1));
  const auto middle = static_cast<std::size_t>(highest);
  for (std::size_t k = 0; k <= middle; ++k) {  // even
    const double frequency = static_cast<double>(k) / static_cast<double>(samples);
    found[middle + k] = found[middle - k] =
        static_cast<float>(1.0 / (kernel.spectrum(frequency) * static_cast<double>(samples)));
  }
  return found;
}

void Synthesizer::Plan::stretched_spectrum(const BandLimitedPulse& pulse, const DopplerNode& node,
                                           const Period& on, std::complex<float>* scratch,
                                           std::span<std::complex<float>> spectrum) const {
  std::fill(scratch, scratch + on.length, 0.0F);
  // An impulse at grid sample i belongs to the time of output sample i − lead: the response stands
  // `lead` samples early.
  const auto n = static_cast<std::ptrdiff_t>(on.length);
  const double reach = pulse.half_duration() / node.doppler;
  const auto first = static_cast<std::ptrdiff_t>(std::ceil(-(reach + node.late) * rate)),
             last = static_cast<std::ptrdiff_t>(std::floor((reach - node.late) * rate));
  for (std::ptrdiff_t j = first; j <= last; ++j) {
    const double t = static_cast<double>(j) / rate + node.late;
    // g(t) = s₊(ηt + T/2)·e^{−i2π f_c t}
    const double cycles = (pulse.centre_frequency() * node.doppler - carrier) * t - node.rotation;
    const std::complex<double> g = pulse.at(node.doppler * t) * std::polar(1.0, 2.0 * pi * cycles);
    const std::ptrdiff_t place = (j - static_cast<std::ptrdiff_t>(on.lead)) % n;
    scratch[place < 0 ? place + n : place] = std::complex<float>(g);
  }
  ComplexFft<float>(on.length).forward(scratch);
  for (std::ptrdiff_t k = -on.highest_bin; k <= on.highest_bin; ++k) {
    const auto i = static_cast<std::size_t>(k + on.highest_bin);
    spectrum[i] = on.deconvolution[i] * scratch[k < 0 ? k + n : k];
  }
}

}  // namespace asdic::detail
