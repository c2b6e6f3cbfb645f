#include "sonar/signal/pulse_spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {
namespace {

/// Samples across the pulse, or one of its parts: enough for the sweep four times over, and for the
/// tapers' kinks. Of short parts of a long pulse fewer, so that all of it is at most 2¹⁷.
std::size_t analysis_intervals(const PulseSettings& s, const Repeats& repeats) {
  if (const auto own = samples_of(s.waveform)) return 2 * own->samples.size();
  const PulseFrequencies through = *frequencies_of(s.waveform, s.duration);
  const double sweep = through.highest - through.lowest;
  const double taper =
      s.window == PulseWindow::tukey && s.tukey_fraction > 0.0 ? s.tukey_fraction : 1.0;
  double for_edges = std::clamp(1024.0 / taper, 4096.0, 65536.0);
  if (repeats.count > 1)
    for_edges = std::clamp(131072.0 * repeats.duration / s.duration, 512.0, for_edges);
  const double intervals = 4.0 * sweep * repeats.duration + for_edges;
  return static_cast<std::size_t>(std::min(intervals, 4e6 * repeats.duration / s.duration + 512.0));
}

/// Σ_k e^{−i2πδ(kI − D)}·e^{i2πfD}, D = ½(n − 1)I: what n parts, keyed out of one oscillator of the
/// frequency f, are to the one in their middle, at f + δ.
std::complex<double> of_repeats(const Repeats& repeats, double f, double delta) {
  const double n = repeats.count, turn = std::remainder(delta * repeats.interval, 1.0);
  // sin(πnδI)/sin(πδI), where δI = m + turn has the sign (−1)^{m(n−1)}
  const double m = std::round(delta * repeats.interval - turn);
  const double sign = std::remainder(m * (n - 1.0), 2.0) == 0.0 ? 1.0 : -1.0;
  const double sum = std::abs(turn) < 1e-9 ? n : std::sin(pi * n * turn) / std::sin(pi * turn);
  const double late = 0.5 * (n - 1.0) * repeats.interval;
  return std::polar(sign * sum, 2.0 * pi * std::remainder(f * late, 1.0));
}

}  // namespace

double PulseSpectrum::frequency(std::size_t k) const noexcept {
  const auto n = static_cast<std::ptrdiff_t>(bins.size());
  const auto i = static_cast<std::ptrdiff_t>(k);
  return bin_width * static_cast<double>(2 * i <= n ? i : i - n);
}

namespace {

PulseSpectrum analysed(const Pulse& pulse, double centre) {
  const Repeats& repeats = pulse.repeats();
  const double duration = repeats.duration;
  const std::size_t intervals = analysis_intervals(pulse.settings(), repeats);
  const double step = duration / static_cast<double>(intervals);
  const std::size_t whole =
      repeats.count == 1 ? intervals : static_cast<std::size_t>(std::ceil(pulse.duration() / step));
  const std::size_t length = fast_fft_length(4 * whole);
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
  if (repeats.count > 1)
    for (std::size_t k = 0; k < length; ++k)
      spectrum.bins[k] *= of_repeats(repeats, pulse.centre_frequency(),
                                     centre + spectrum.frequency(k) - pulse.centre_frequency());
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
