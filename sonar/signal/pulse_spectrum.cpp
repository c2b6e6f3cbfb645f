#include "sonar/signal/pulse_spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {
namespace {

/// Samples across the pulse: enough for the sweep four times over, and for the tapers' kinks.
std::size_t analysis_intervals(const PulseSettings& s) {
  if (const auto own = samples_of(s.waveform)) return 2 * own->samples.size();
  const PulseFrequencies through = *frequencies_of(s.waveform);
  const double sweep = through.highest - through.lowest;
  const double taper =
      s.window == PulseWindow::tukey && s.tukey_fraction > 0.0 ? s.tukey_fraction : 1.0;
  const double intervals = 4.0 * sweep * s.duration + std::clamp(1024.0 / taper, 4096.0, 65536.0);
  return static_cast<std::size_t>(std::min(intervals, 4e6));
}

}  // namespace

double PulseSpectrum::frequency(std::size_t k) const noexcept {
  const auto n = static_cast<std::ptrdiff_t>(bins.size());
  const auto i = static_cast<std::ptrdiff_t>(k);
  return bin_width * static_cast<double>(2 * i <= n ? i : i - n);
}

namespace {

PulseSpectrum analysed(const Pulse& pulse, double centre) {
  const double duration = pulse.duration();
  const std::size_t intervals = analysis_intervals(pulse.settings());
  const double step = duration / static_cast<double>(intervals);
  const std::size_t length = fast_fft_length(4 * intervals);
  FftBuffer<std::complex<double>> x(length);
  for (std::size_t j = 0; j <= intervals; ++j) {
    // The edges are nudged inside, where the pulse has its one-sided limit, and weigh half.
    const bool edge = j == 0 || j == intervals;
    const double t = std::clamp(static_cast<double>(j) * step, 0.0, duration);
    const double u = t - 0.5 * duration;
    const auto value =
        pulse.analytic(t) * std::polar(edge ? 0.5 * step : step, -2.0 * pi * centre * u);
    // u = 0 belongs at sample 0: the pulse's first half stands at the end of the period.
    const std::size_t shift = length - intervals / 2;
    x[(j + shift) % length] = value;
  }
  ComplexFft<double>(length).forward(x.data());
  PulseSpectrum spectrum;
  spectrum.bin_width = 1.0 / (step * static_cast<double>(length));
  spectrum.bins.assign(x.data(), x.data() + length);
  // Sample intervals/2 is u = 0 only if the number of intervals is even; put half a step right.
  if (intervals % 2 == 1)
    for (std::size_t k = 0; k < length; ++k)
      spectrum.bins[k] *= std::polar(1.0, 2.0 * pi * spectrum.frequency(k) * 0.5 * step);
  return spectrum;
}

}  // namespace

/// It takes a millisecond, as long as all else of a cheap ping, and studies ask for the same one
/// again and again: each thread keeps the last, found by equal settings.
PulseSpectrum pulse_spectrum(const Pulse& pulse, double centre) {
  constexpr std::size_t most_kept = std::size_t{1} << 17;
  if (samples_of(pulse.settings().waveform)) return analysed(pulse, centre);
  struct Kept {
    PulseSettings settings;
    double centre = 0.0;
    PulseSpectrum spectrum;
  };
  thread_local Kept kept;
  if (!kept.spectrum.bins.empty() && kept.settings == pulse.settings() && kept.centre == centre)
    return kept.spectrum;
  PulseSpectrum spectrum = analysed(pulse, centre);
  if (spectrum.bins.size() <= most_kept) kept = {pulse.settings(), centre, spectrum};
  return spectrum;
}

double bandwidth(const PulseSpectrum& spectrum, double down_db) {
  double peak = 0.0, widest = 0.0;
  for (const auto& c : spectrum.bins) peak = std::max(peak, std::norm(c));
  const double floor = peak * power_from_db(-down_db);
  for (std::size_t k = 0; k < spectrum.bins.size(); ++k)
    if (std::norm(spectrum.bins[k]) >= floor)
      widest = std::max(widest, std::abs(spectrum.frequency(k)));
  return 2.0 * (widest + 0.5 * spectrum.bin_width);
}

double bandwidth_of_energy(const PulseSpectrum& spectrum, double share) {
  const std::size_t n = spectrum.bins.size();
  double all = 0.0;
  for (const auto& c : spectrum.bins) all += std::norm(c);
  const std::size_t k = outermost_pair(n / 2, (1.0 - share) * all, [&](std::size_t i) {
    return std::norm(spectrum.bins[i]) + std::norm(spectrum.bins[n - i]);
  });
  return 2.0 * static_cast<double>(k + 1) * spectrum.bin_width;
}

double bandwidth_for_error(const PulseSpectrum& spectrum, double error) {
  const std::size_t n = spectrum.bins.size();
  const std::size_t k = outermost_pair(n / 2, error, [&](std::size_t i) {
    const double one = std::norm(spectrum.bins[i]), other = std::norm(spectrum.bins[n - i]);
    return (std::sqrt(one) + std::sqrt(other)) * spectrum.bin_width;
  });
  return 2 * k > n / 2 ? infinity : 2.0 * static_cast<double>(k + 1) * spectrum.bin_width;
}

}  // namespace asdic::detail
