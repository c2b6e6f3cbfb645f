#include "sonar/signal/band_limited_pulse.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/pulse_spectrum.h"

namespace asdic::detail {
namespace {

constexpr double tail_error = 3e-5;      // of the peak, −90 dB
constexpr double slope_share = 0.075;    // half the filter's slope over the width of its flat part
constexpr double slope_steepness = 2.7;  // ½ erfc(2.7) = 7e-5 is left where the slope is cut off

}  // namespace

BandLimitedPulse::BandLimitedPulse(const Pulse& pulse, double sample_rate,
                                   const std::function<double(double)>& response, double recorded)
    : centre_frequency_(pulse.centre_frequency()) {
  const PulseSpectrum spectrum = pulse_spectrum(pulse, centre_frequency_);
  const double analysed = spectrum.bin_width * static_cast<double>(spectrum.bins.size());
  constexpr double all_over_flat = 1.0 + 4.0 * slope_share;
  const double lossless = bandwidth_for_error(spectrum, tail_error);
  const double widest =
      pulse.jumps_at_its_edges() ? 4.0 * pulse.bandwidth_40db() : 2.0 * sample_rate;
  const double flat =
      std::min({lossless, widest, recorded / all_over_flat, analysed / (2.0 + 8.0 * slope_share)});
  const double slope = slope_share * flat;
  half_band_ = 0.5 * flat + 2.0 * slope;

  // Back to time at four times the highest frequency kept, as SampledSignal likes it.
  const std::size_t all = spectrum.bins.size();
  const std::size_t wanted = static_cast<std::size_t>(4.0 * half_band_ / spectrum.bin_width) + 1;
  const std::size_t length = std::min(all, fast_fft_length(wanted));
  FftBuffer<std::complex<double>> x(length);
  const auto edge = static_cast<std::ptrdiff_t>(half_band_ / spectrum.bin_width);
  const auto n = static_cast<std::ptrdiff_t>(length);
  for (std::ptrdiff_t k = -std::min(edge, (n - 1) / 2); k <= std::min(edge, (n - 1) / 2); ++k) {
    const double beyond =
        std::abs(static_cast<double>(k)) * spectrum.bin_width - 0.5 * flat - slope;
    const double filter = 0.5 * std::erfc(slope_steepness * beyond / slope);
    const double passed =
        response ? filter * response(static_cast<double>(k) * spectrum.bin_width) : filter;
    x[static_cast<std::size_t>(k < 0 ? k + n : k)] =
        passed * spectrum.bin_width *
        spectrum.bins[static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(all) : k)];
  }
  ComplexFft<double>(length).inverse(x.data());

  // The filter's response is a sinc under exp(−(πt·slope/2.7)²): 1e-5 at t = 2.9/slope.
  const double ringing = flat < lossless ? 2.9 / slope : 1.0 / flat;
  const double rate = spectrum.bin_width * static_cast<double>(length);
  const auto reach =
      std::min((n - 1) / 2,
               static_cast<std::ptrdiff_t>(std::ceil((0.5 * pulse.duration() + ringing) * rate)));
  std::vector<std::complex<double>> samples;
  samples.reserve(static_cast<std::size_t>(2 * reach + 1));
  for (std::ptrdiff_t j = -reach; j <= reach; ++j)
    samples.push_back(x[static_cast<std::size_t>(j < 0 ? j + n : j)]);
  const double first = -static_cast<double>(reach) / rate;
  signal_ = SampledSignal(samples, first, rate);
  half_duration_ = -first + 12.0 / rate;  // SampledSignal's own reach
}

double half_band_of_energy(const BandLimitedPulse& pulse, double left_out) {
  const double rate = 2.5 * pulse.half_band();
  const auto reach = static_cast<std::ptrdiff_t>(pulse.half_duration() * rate);
  const std::size_t n = fast_fft_length(4 * static_cast<std::size_t>(reach) + 2);
  FftBuffer<std::complex<double>> x(n);
  for (std::ptrdiff_t j = -reach; j <= reach; ++j)
    x[static_cast<std::size_t>(j < 0 ? j + static_cast<std::ptrdiff_t>(n) : j)] =
        pulse.at(static_cast<double>(j) / rate);
  ComplexFft<double>(n).forward(x.data());
  PulseSpectrum spectrum{.bin_width = rate / static_cast<double>(n), .bins = {}};
  spectrum.bins.assign(x.data(), x.data() + n);
  return std::min(pulse.half_band(), 0.5 * bandwidth_of_energy(spectrum, 1.0 - left_out));
}

namespace {

/// Full width in ν [Hz] of the frequencies f + ν of a pulse that a complex recording holds under
/// every Doppler factor, |η(f + ν) − f_rec| ≤ rate/2. Two bins of the period are left for rounding
/// the carrier and the band to bins.
double recorded_width(const Pulse& sent, const Recording& record, double max_doppler) {
  if (!record.is_complex()) return infinity;
  const double f = sent.centre_frequency();
  const double bin = record.sample_rate / static_cast<double>(record.samples);
  const double half = 0.5 * record.sample_rate - 2.0 * bin - std::abs(f - record.carrier);
  return std::max(2.0 * (half - f * max_doppler) / (1.0 + max_doppler), sent.bandwidth_40db());
}

}  // namespace

BandLimitedPulse recorded_pulse(const Pulse& sent, const Recording& record, double max_doppler,
                                const std::function<double(double)>& filter) {
  const double rate =
      record.is_complex() ? 2.0 * record.carrier + record.sample_rate : record.sample_rate;
  return {sent, rate, filter, recorded_width(sent, record, max_doppler)};
}

}  // namespace asdic::detail
