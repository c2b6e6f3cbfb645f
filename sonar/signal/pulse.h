#pragma once
#include <complex>
#include <span>
#include <string_view>
#include <vector>

#include "sonar/signal/sampled_signal.h"
#include "sonar/signal/waveforms/waveforms.h"

namespace asdic::detail {

enum class PulseWindow { none, hann, tukey };
inline constexpr std::string_view pulse_window_words[] = {"none", "hann", "tukey"};
constexpr std::span<const std::string_view> words(PulseWindow /*any*/) {
  return pulse_window_words;
}

/// A pulse as a scenario says it: a waveform under a window.
struct PulseSettings {
  AnyWaveform waveform = Cw{};
  double duration = 1.0;  ///< [s]; a sampled waveform has its own
  PulseWindow window =
      PulseWindow::hann;        ///< of a sampled waveform none, and so of files that say none
  double tukey_fraction = 0.1;  ///< share of the duration in the two tapers together, 0..1

  void describe(Fields& field);
  [[nodiscard]] bool operator==(const PulseSettings&) const = default;
};

/// A transmitted pulse s₊(t), analytic, of unit peak envelope before its window; t = 0 is the
/// leading edge, zero outside [0, duration]. Time dependence e^{+iωt}; the pressure at 1 m is
/// Re{√2·10^(SL/20) µPa · s₊(t)}.
class Pulse {
 public:
  /// \throws InputError naming the setting at fault ("duration", "frequency", …)
  explicit Pulse(PulseSettings settings);

  [[nodiscard]] std::complex<double> analytic(double t) const noexcept;

  [[nodiscard]] double duration() const noexcept { return settings_.duration; }
  [[nodiscard]] double centre_frequency() const noexcept { return centre_frequency_; }
  /// Full width around the centre outside which the spectrum stays 40 dB below its peak [Hz]:
  /// 63/T for an unwindowed tone with its slow side lobes, 5.75/T under a Hann window. At most
  /// twice the centre frequency.
  [[nodiscard]] double bandwidth_40db() const noexcept { return bandwidth_40db_; }
  /// Full width around the centre that holds 99 % of the energy [Hz]: 21/T for an unwindowed tone,
  /// 3.3/T under a Hann window, the sweep for one that is long and not windowed. At most the −40 dB
  /// bandwidth.
  [[nodiscard]] double bandwidth_99() const noexcept { return bandwidth_99_; }
  /// Full width around the centre that samples of the pulse should hold [Hz]: what lies outside
  /// amounts to less than 2e-4 of the peak at any time, by a bound (found: 1e-4, −80 dB). A pulse
  /// whose edges jump has no such width, and its −40 dB bandwidth here.
  [[nodiscard]] double sampled_bandwidth() const noexcept { return sampled_bandwidth_; }
  /// Whether it, or one of its parts, begins or ends at once, as without a window.
  [[nodiscard]] bool jumps_at_its_edges() const noexcept;
  /// ∫|s₊|²dt [s]: the duration for an unwindowed pulse, 3/8 of it under a Hann window; less of
  /// tones at once and of a train.
  [[nodiscard]] double energy() const noexcept { return energy_; }
  /// By how much that is less than of one tone of the same duration, window and peak [dB].
  [[nodiscard]] double below_a_tone_db() const noexcept;
  /// Its parts; of most pulses one, the whole.
  [[nodiscard]] const Repeats& repeats() const noexcept { return repeats_; }
  [[nodiscard]] const PulseSettings& settings() const noexcept { return settings_; }

 private:
  PulseSettings settings_;
  double centre_frequency_ = 0.0, bandwidth_40db_ = 0.0, bandwidth_99_ = 0.0;
  double sampled_bandwidth_ = 0.0, energy_ = 0.0;
  bool sampled_ = false;
  Repeats repeats_;
  std::vector<Tone> tones_;  // of one that is several at once
  double scale_ = 1.0;       // of them, to a peak of 1
  SampledSignal signal_;     // of a sampled one: analytic, twice oversampled, unit peak
};

/// Re s₊ sampled at the phones' rate: what a matched filter needs. \return
/// [ceil(duration·sample_rate) + 1]
[[nodiscard]] std::vector<float> replica(const Pulse& pulse, double sample_rate);
/// s₊·e^{−i2πf_c t} sampled at the baseband's rate, t from the leading edge. \return
/// [2 × (ceil(duration·rate) + 1)] real and imaginary part in turn
[[nodiscard]] std::vector<float> baseband_replica(const Pulse& pulse, double rate, double carrier);

}  // namespace asdic::detail
