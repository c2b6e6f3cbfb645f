#pragma once
#include <complex>
#include <span>
#include <vector>

#include "sonar/scenario.h"
#include "sonar/synthesis.h"

namespace asdic {

/// What the phones' electronics make of what they hear: gain and phase of every channel, band-pass,
/// analogue-to-digital conversion.
///
/// The response has no delay: Butterworth's magnitude with its phase taken out, times the channel's
/// gain, times e^{iφ} at frequencies above 0. Drawn errors are keyed by the channel: the same in
/// every ping. Source: docs/theory/receiver.md
class ReceiverElectronics {
 public:
  explicit ReceiverElectronics(const Scenario& scenario);

  /// Whether every channel gives what it hears, apart from its converter.
  [[nodiscard]] bool is_flat() const noexcept { return flat_; }

  /// The sound of one ping, filtered in its period of the synthesis: there are no edges in it.
  void respond(Baseband& sound) const;

  /// Inputs of the part before, which a filter still needs.
  using Carried = std::vector<float>;
  /// Noise of one part of a stream, [channels × samples × components], by overlap and save: it goes
  /// on from the part before without a gap. It comes out half a filter late, which noise does not
  /// mind. Without a part before, its own end stands for it.
  void respond(std::span<float> noise, const Recording& recording, Carried* carried) const;

  /// Rounds to the converter's steps and clips: −full scale … full scale − 1 step, real and
  /// imaginary part each.
  void convert(std::span<float> samples, const Recording& recording) const;

  /// Response of a channel at a frequency above 0.
  [[nodiscard]] std::complex<double> response(std::size_t channel, double frequency) const noexcept;

 private:
  struct Channel {
    std::complex<double> gain = 1.0;  // 0: dead
    std::optional<Electronics::BandPass> band_pass;
    std::optional<Electronics::Converter> converter;
  };
  [[nodiscard]] double memory() const noexcept;

  std::vector<Channel> channels_;
  bool flat_ = true;
};

/// |H| of a band-pass at a frequency above 0 [Hz].
[[nodiscard]] double magnitude(const Electronics::BandPass& filter, double frequency) noexcept;

}  // namespace asdic
