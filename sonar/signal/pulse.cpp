#include "sonar/signal/pulse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/pulse_spectrum.h"

namespace asdic {
namespace {

std::string in_units(double value, const char* unit) {
  std::ostringstream text;
  text << value << unit;
  return text.str();
}

void require_positive(double value, const char* name, const char* unit) {
  if (!(value > 0.0 && std::isfinite(value)))
    throw InputError(
        {.where = name, .got = in_units(value, unit), .expected = "a finite number above 0"});
}

void check(const PulseSettings& s) {
  if (s.kind == PulseKind::file) {
    require_positive(s.sample_rate, "sample_rate", " Hz");
    if (s.samples.size() < 2)
      throw InputError({.where = "samples",
                        .got = std::to_string(s.samples.size()) + " samples",
                        .expected = "at least 2"});
    if (!std::all_of(s.samples.begin(), s.samples.end(), [](double x) { return std::isfinite(x); }))
      throw InputError(
          {.where = "samples", .got = "nan or infinity", .expected = "finite samples"});
  } else {
    require_positive(s.duration, "duration", " s");
  }
  if (s.kind == PulseKind::cw) require_positive(s.frequency, "frequency", " Hz");
  if (s.kind == PulseKind::lfm || s.kind == PulseKind::hfm) {
    require_positive(s.start_frequency, "start_frequency", " Hz");
    require_positive(s.end_frequency, "end_frequency", " Hz");
  }
  if (s.window == PulseWindow::tukey && !(s.tukey_fraction >= 0.0 && s.tukey_fraction <= 1.0))
    throw InputError({.where = "tukey_fraction",
                      .got = in_units(s.tukey_fraction, ""),
                      .expected = "a share between 0 and 1"});
}

/// Amplitude of the window at t/T = x in [0, 1].
double window(const PulseSettings& s, double x) noexcept {
  const double edge = std::min(x, 1.0 - x);  // distance from the nearer edge
  switch (s.window) {
    case PulseWindow::none:
      return 1.0;
    case PulseWindow::hann: {
      const double root = std::sin(pi * edge);
      return root * root;  // sin²(πt/T)
    }
    case PulseWindow::tukey: {
      if (edge >= 0.5 * s.tukey_fraction) return 1.0;
      const double root = std::sin(pi * edge / s.tukey_fraction);
      return root * root;  // sin²(πt/(αT)), α the share of both tapers
    }
  }
  return 1.0;
}

/// Phase of s₊ at t [rad], 0 at the leading edge.
double phase(const PulseSettings& s, double t) noexcept {
  if (s.kind == PulseKind::cw) return 2.0 * pi * s.frequency * t;
  const double f1 = s.start_frequency, f2 = s.end_frequency;
  const double slope = (f2 - f1) / s.duration;
  if (s.kind == PulseKind::lfm) return 2.0 * pi * t * (f1 + 0.5 * slope * t);
  // HFM: the period is linear in time, 1/f = 1/f₁ + b·t, so ∫f dt = ln(1 + b f₁ t)/b, written so
  // that b = 0 is a tone. Kroszczyński, Proc. IEEE 57, 1260 (1969).
  const double x = -slope / f2 * t;  // b f₁ t, b = (1/f₂ − 1/f₁)/T = −slope/(f₁ f₂)
  return 2.0 * pi * f1 * t * (std::abs(x) < 1e-8 ? 1.0 - 0.5 * x : std::log1p(x) / x);
}

/// The analytic signal of real samples, twice oversampled: FFT, negative frequencies dropped,
/// positive ones doubled, inverse FFT of twice the length. Padded by as much silence again.
std::vector<std::complex<double>> analytic_signal(const std::vector<double>& samples) {
  const std::size_t n = samples.size(), length = 2 * fast_fft_length(n);
  FftBuffer<std::complex<double>> x(2 * length);
  std::copy(samples.begin(), samples.end(), x.data());
  ComplexFft<double>(length).forward(x.data());
  for (std::size_t k = 1; k < length; ++k)
    x[k] *= 2 * k < length ? 2.0 : (2 * k == length ? 1.0 : 0.0);
  ComplexFft<double>(2 * length).inverse(x.data());
  std::vector<std::complex<double>> fine(x.data(), x.data() + 2 * n);
  for (auto& value : fine) value /= static_cast<double>(length);
  return fine;
}

/// Energy-weighted mean frequency [Hz] of analytic samples at `rate`.
double spectral_centre(const std::vector<std::complex<double>>& samples, double rate) {
  // The mean of the instantaneous frequency weighted by |s|²: Σ Im(s*ₙ sₙ₊₁)… by its phase.
  std::complex<double> lag = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) lag += std::conj(samples[i - 1]) * samples[i];
  return std::arg(lag) / (2.0 * pi) * rate;
}

struct Widths {
  double down_40db = 0.0;  // outside which the spectrum stays 40 dB below its peak [Hz]
  double energy_99 = 0.0;  // that hold 99 % of the energy [Hz]
  double sampled = 0.0;    // outside which less than 2e-4 of the peak is lost at any time [Hz]
};

/// A scenario's pulse is made a dozen times while it is read and simulated, and its spectrum takes
/// a millisecond: each thread remembers the last few widths that it found, by the numbers that they
/// depend on.
Widths widths_of(const Pulse& pulse) {
  const PulseSettings& s = pulse.settings();
  const auto found = [&]() -> Widths {
    const PulseSpectrum spectrum = pulse_spectrum(pulse, pulse.centre_frequency());
    return {bandwidth(spectrum, 40.0), bandwidth_of_energy(spectrum, 0.99),
            bandwidth_for_error(spectrum, 2e-4)};
  };
  if (s.kind == PulseKind::file) return found();
  struct Known {
    PulseSettings settings;
    Widths widths;
  };
  thread_local std::array<Known, 4> known;
  thread_local std::size_t next = 0;
  for (const Known& k : known)
    if (k.widths.down_40db > 0.0 && k.settings == s) return k.widths;
  const Widths widths = found();
  known[next++ % known.size()] = {s, widths};
  return widths;
}

/// ∫|s₊|²dt [s]: in closed form, or by Parseval's theorem, Σ|C|²Δν.
double energy_of(const Pulse& pulse) {
  const PulseSettings& s = pulse.settings();
  if (s.kind == PulseKind::file) {
    const PulseSpectrum spectrum = pulse_spectrum(pulse, pulse.centre_frequency());
    double sum = 0.0;
    for (const auto& c : spectrum.bins) sum += std::norm(c) * spectrum.bin_width;
    return sum;
  }
  const double taper = s.window == PulseWindow::none    ? 0.0
                       : s.window == PulseWindow::tukey ? s.tukey_fraction
                                                        : 1.0;
  return s.duration * (1.0 - 0.625 * taper);
}

}  // namespace

Pulse::Pulse(PulseSettings settings) : settings_(std::move(settings)) {
  check(settings_);
  switch (settings_.kind) {
    case PulseKind::cw:
      centre_frequency_ = settings_.frequency;
      break;
    case PulseKind::lfm:
    case PulseKind::hfm:
      centre_frequency_ = 0.5 * (settings_.start_frequency + settings_.end_frequency);
      break;
    case PulseKind::file: {
      settings_.duration = static_cast<double>(settings_.samples.size()) / settings_.sample_rate;
      auto fine = analytic_signal(settings_.samples);
      double peak = 0.0;
      for (const auto& s : fine) peak = std::max(peak, std::abs(s));
      if (peak == 0.0)
        throw InputError({.where = "samples", .got = "silence", .expected = "a sound"});
      for (auto& s : fine) s /= peak;
      centre_frequency_ = spectral_centre(fine, 2.0 * settings_.sample_rate);
      file_signal_ = SampledSignal(fine, 0.0, 2.0 * settings_.sample_rate);
      break;
    }
  }
  const Widths widths = widths_of(*this);
  bandwidth_40db_ = std::min(widths.down_40db, 2.0 * centre_frequency_);
  bandwidth_99_ = std::min(widths.energy_99, bandwidth_40db_);
  const bool has_none = jumps_at_its_edges() || std::isinf(widths.sampled);
  sampled_bandwidth_ = has_none
                           ? bandwidth_40db_
                           : std::clamp(widths.sampled, bandwidth_40db_, 2.0 * centre_frequency_);
  energy_ = energy_of(*this);
}

bool Pulse::jumps_at_its_edges() const noexcept {
  return std::abs(analytic(0.0)) > 1e-3 || std::abs(analytic(duration())) > 1e-3;
}

std::complex<double> Pulse::analytic(double t) const noexcept {
  if (!(t >= 0.0 && t <= settings_.duration)) return 0.0;
  const double amplitude = window(settings_, t / settings_.duration);
  if (settings_.kind == PulseKind::file) return amplitude * file_signal_.at(t);
  return std::polar(amplitude, phase(settings_, t));
}

std::vector<float> replica(const Pulse& pulse, double sample_rate) {
  const auto last = static_cast<std::size_t>(std::ceil(pulse.duration() * sample_rate));
  std::vector<float> samples(last + 1);
  for (std::size_t i = 0; i <= last; ++i)
    samples[i] = static_cast<float>(pulse.analytic(static_cast<double>(i) / sample_rate).real());
  return samples;
}

std::vector<float> baseband_replica(const Pulse& pulse, double rate, double carrier) {
  const auto last = static_cast<std::size_t>(std::ceil(pulse.duration() * rate));
  std::vector<float> samples;
  for (std::size_t i = 0; i <= last; ++i) {
    const double t = static_cast<double>(i) / rate, cycles = carrier * t;
    const std::complex<double> value =
        pulse.analytic(t) * std::polar(1.0, -2.0 * pi * (cycles - std::floor(cycles)));
    samples.push_back(static_cast<float>(value.real()));
    samples.push_back(static_cast<float>(value.imag()));
  }
  return samples;
}

}  // namespace asdic
