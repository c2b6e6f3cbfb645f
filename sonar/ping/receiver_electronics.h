#pragma once
#include <complex>
#include <span>
#include <vector>

#include "sonar/scenario/scenario.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// What the phones' electronics make of what they receive: gain and phase of every channel,
/// band-pass, analogue-to-digital conversion.
///
/// The response has no delay: Butterworth's magnitude with its phase taken out, times the channel's
/// gain, times e^{iφ} at frequencies above 0. Drawn errors are keyed by the channel: the same in
/// every ping. Source: docs/theory/receiver.md
class ReceiverElectronics {
 public:
  explicit ReceiverElectronics(const Scenario& scenario);

  /// Whether every channel gives what it receives, apart from its converter.
  [[nodiscard]] bool is_flat() const noexcept { return flat_; }

  /// The sound of one ping, filtered in its period of the synthesis: there are no edges in it.
  void respond(Baseband& sound) const;

  /// Half of the filters' memory [samples]: as much of what is to come is needed; 0 if flat.
  [[nodiscard]] std::size_t ahead(const Recording& recording) const noexcept;
  /// The inputs before those of a part, [channels × 2·ahead × components].
  using Carried = std::vector<float>;
  /// What has no beginning, through the response by overlap and save. \param received  [channels ×
  /// samples × components] in: the sound `ahead` samples after each sample of the part; out: the
  /// part   \param carried  in: the inputs before them; out: those before the next part's
  void respond(std::span<float> received, const Recording& recording, Carried& carried) const;

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

}  // namespace asdic::detail
