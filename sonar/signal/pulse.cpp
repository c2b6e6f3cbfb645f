#include "sonar/signal/pulse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check_settings.h"
#include "core/error.h"
#include "core/quantities.h"
#include "core/units.h"
#include "sonar/signal/complex_product.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/pulse_spectrum.h"

namespace asdic::detail {
namespace {

/// A sampled waveform has its own duration and edges.
void take_own_length(PulseSettings& settings, const SoundSamples& own) {
  settings.duration = own.duration();
  settings.window = PulseWindow::none;
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

/// The analytic signal of real samples, twice oversampled: FFT, negative frequencies dropped,
/// positive ones doubled, inverse FFT of twice the length. Padded by as much silence again.
std::vector<std::complex<double>> analytic_signal(std::span<const double> samples) {
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
  if (samples_of(s.waveform)) return found();
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

/// Σ e^{i(2πf_n t + φ_n)} at even steps from 0, each tone turned on from one to the next.
class TonesInSteps {
 public:
  TonesInSteps(const std::vector<Tone>& tones, double step) {
    for (const Tone& tone : tones) {
      now_.push_back(std::polar(1.0, tone.phase));
      turn_.push_back(std::polar(1.0, 2.0 * pi * tone.frequency * step));
    }
  }
  [[nodiscard]] std::complex<double> next() {
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < now_.size(); ++n) {
      sum += now_[n];
      now_[n] = finite_product(now_[n], turn_[n]);
    }
    return sum;
  }

 private:
  std::vector<std::complex<double>> now_, turn_;
};

/// Even steps, so many that the envelope of tones hardly bends from one to the next: 16 in the
/// period of the highest beat, between which a peak stands out by less than (π/32)²/2, half a
/// per cent, before a parabola through three of them.
std::size_t steps_of(const PulseSettings& s) {
  const PulseFrequencies through = *frequencies_of(s.waveform, s.duration);
  const double wanted = 16.0 * (through.highest - through.lowest) * s.duration;
  return 2 * static_cast<std::size_t>(std::clamp(0.5 * wanted, 2048.0, 2e7)) + 2;
}

/// The largest |Σ e^{i(2πf_n t + φ_n)}| within the duration.
double peak_of(const std::vector<Tone>& tones, const PulseSettings& s) {
  const std::size_t steps = steps_of(s);
  TonesInSteps sum(tones, s.duration / static_cast<double>(steps));
  double before = std::norm(sum.next()), here = std::norm(sum.next()),
         most = std::max(before, here);
  for (std::size_t i = 2; i <= steps; ++i) {
    const double after = std::norm(sum.next()), bend = before - 2.0 * here + after;
    if (here >= before && here >= after && bend < 0.0) {
      const double offset = 0.5 * (before - after) / bend;
      most = std::max(most, here - 0.25 * (before - after) * offset);
    }
    before = here;
    here = after;
  }
  return std::sqrt(std::max(most, here));
}

/// ∫w²|Σ e^{i(2πf_n t + φ_n)}|²dt by Simpson's rule.
double energy_of(const std::vector<Tone>& tones, const PulseSettings& s) {
  const std::size_t steps = steps_of(s);  // an even number
  const double step = s.duration / static_cast<double>(steps);
  TonesInSteps sum(tones, step);
  double all = 0.0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double w = window(s, static_cast<double>(i) / static_cast<double>(steps));
    const double weight = i == 0 || i == steps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    all += weight * w * w * std::norm(sum.next());
  }
  return all * step / 3.0;
}

/// ∫w²dt over so long [s].
double energy_of_window(const PulseSettings& s, double duration) {
  const double taper = s.window == PulseWindow::none    ? 0.0
                       : s.window == PulseWindow::tukey ? s.tukey_fraction
                                                        : 1.0;
  return duration * (1.0 - 0.625 * taper);
}

/// The scale of tones to a peak of 1, and their energy at it: found once, as the widths are.
struct TonesMeasured {
  double scale = 1.0, energy = 0.0;
};
TonesMeasured measured_tones(const std::vector<Tone>& tones, const PulseSettings& s) {
  struct Known {
    PulseSettings settings;
    TonesMeasured measured;
  };
  thread_local std::array<Known, 4> known;
  thread_local std::size_t next = 0;
  for (const Known& k : known)
    if (k.measured.energy > 0.0 && k.settings == s) return k.measured;
  const double scale = 1.0 / peak_of(tones, s);
  const TonesMeasured found{.scale = scale, .energy = scale * scale * energy_of(tones, s)};
  known[next++ % known.size()] = {s, found};
  return found;
}

/// ∫|s₊|²dt [s]: in closed form, or by Parseval's theorem, Σ|C|²Δν.
double energy_of(const Pulse& pulse) {
  const PulseSettings& s = pulse.settings();
  if (samples_of(s.waveform)) {
    const PulseSpectrum spectrum = pulse_spectrum(pulse, pulse.centre_frequency());
    double sum = 0.0;
    for (const auto& c : spectrum.bins) sum += std::norm(c) * spectrum.bin_width;
    return sum;
  }
  return pulse.repeats().count * energy_of_window(s, pulse.repeats().duration);
}

/// What a waveform asks of its settings together with the duration.
void check_waveform(const AnyWaveform& waveform, Fields& field, double duration) {
  std::visit(
      [&](const auto& one) {
        if constexpr (requires { one.check(field, duration); }) one.check(field, duration);
      },
      waveform);
}

}  // namespace

void PulseSettings::describe(Fields& field) {
  field.one_of(required("kind"), waveform, "what it is made of");
  const auto only_if_made = field.unless("kind", name_of(waveform), SampledPulse::name);
  if (!only_if_made) {
    if (field.reads()) take_own_length(*this, *samples_of(waveform));
    field.derived(duration);
    return;
  }
  field(required("duration"), duration, quantity::pulse_duration,
        "from the leading to the trailing edge");
  if (field.checks()) check_waveform(waveform, field, duration);
  if (field.reads() || field.exhaustive())
    window = PulseWindow::none;  // a file without the key has none
  field("window", window, "how the edges rise and fall");
  if (const auto only = field.only("window", window, PulseWindow::tukey))
    field("tukey_fraction", tukey_fraction, {.noun = "fraction", .low = 0.0, .high = 1.0},
          "share of the duration in the two tapers together");
}

Pulse::Pulse(PulseSettings settings) : settings_(std::move(settings)) {
  check_settings(settings_);
  if (const auto own = samples_of(settings_.waveform)) {
    take_own_length(settings_, *own);
    auto fine = analytic_signal(own->samples);
    double peak = 0.0;
    for (const auto& s : fine) peak = std::max(peak, std::abs(s));
    if (peak == 0.0)
      throw InputError({.where = "samples", .got = "silence", .expected = "a sound"});
    for (auto& s : fine) s /= peak;
    centre_frequency_ = spectral_centre(fine, 2.0 * own->sample_rate);
    signal_ = SampledSignal(fine, 0.0, 2.0 * own->sample_rate);
    sampled_ = true;
  } else {
    const PulseFrequencies through = *frequencies_of(settings_.waveform, settings_.duration);
    centre_frequency_ = 0.5 * (through.lowest + through.highest);
  }
  repeats_ = repeats_of(settings_.waveform, settings_.duration);
  tones_ = tones_of(settings_.waveform);
  if (!tones_.empty()) scale_ = measured_tones(tones_, settings_).scale;
  const Widths widths = widths_of(*this);
  bandwidth_40db_ = std::min(widths.down_40db, 2.0 * centre_frequency_);
  bandwidth_99_ = std::min(widths.energy_99, bandwidth_40db_);
  const bool has_none = jumps_at_its_edges() || std::isinf(widths.sampled);
  sampled_bandwidth_ = has_none
                           ? bandwidth_40db_
                           : std::clamp(widths.sampled, bandwidth_40db_, 2.0 * centre_frequency_);
  energy_ = tones_.empty() ? energy_of(*this) : measured_tones(tones_, settings_).energy;
}

double Pulse::below_a_tone_db() const noexcept {
  return -db_from_power(energy_ / energy_of_window(settings_, settings_.duration));
}

bool Pulse::jumps_at_its_edges() const noexcept {
  return std::abs(analytic(0.0)) > 1e-3 || std::abs(analytic(duration())) > 1e-3;
}

std::complex<double> Pulse::analytic(double t) const noexcept {
  if (!(t >= 0.0 && t <= settings_.duration)) return 0.0;
  const double u = t - repeats_.at(t) * repeats_.interval;  // within one of its parts
  if (u > repeats_.duration * (1.0 + 1e-12)) return 0.0;
  const double amplitude = window(settings_, std::min(u / repeats_.duration, 1.0));
  if (sampled_) return amplitude * signal_.at(t);
  if (!tones_.empty()) {
    std::complex<double> sum = 0.0;
    for (const Tone& tone : tones_)
      sum += std::polar(1.0, 2.0 * pi * tone.frequency * t + tone.phase);
    return scale_ * amplitude * sum;
  }
  return std::polar(amplitude, phase_of(settings_.waveform, t, settings_.duration));
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

}  // namespace asdic::detail
