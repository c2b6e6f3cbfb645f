#pragma once
#include <vector>

#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// What of a pulse's band a beam and its matched filter answer to. Of sound that comes evenly over
/// delay the filter lets through ∫|S|⁴|w(f)·e|²df, of sound that is shifted by ν against its
/// replica ∫|S(f + ½ν)|²|S(f − ½ν)|²df.
class PulseBand {
 public:
  explicit PulseBand(const Pulse& pulse);

  /// A part of the band, at its middle relative to the centre.
  struct Line {
    double ratio = 1.0, lowest = 0.0, highest = 0.0;  // [1], from the centre [Hz], [Hz]
  };
  /// The band in lines so close that whatever repeats itself once in 1/delay [Hz] is told apart.
  /// \param most  no more of them
  [[nodiscard]] std::vector<Line> lines(double delay, int most) const;
  /// Of ∫|S|⁴df what each passes of sound that is shifted against the replica [Hz], about the
  /// middle of both.
  [[nodiscard]] std::vector<double> shares(const std::vector<Line>& lines, double shift) const;
  /// What passes of sound that is shifted against the replica [Hz]; 1 of none.
  [[nodiscard]] double passes(double shift) const noexcept;
  /// Shift of which half passes [Hz].
  [[nodiscard]] double half() const noexcept { return half_; }
  /// How much later at most sound is answered, for its shift [s].
  [[nodiscard]] double later(double shift) const noexcept;

 private:
  /// From the centre [Hz].
  [[nodiscard]] double frequency(std::size_t k) const noexcept {
    return step_ * (static_cast<double>(k) - static_cast<double>(power_.size() / 2));
  }

  [[nodiscard]] double power_at(double place) const noexcept;

  double centre_, step_, duration_, half_ = 0.0, fourth_ = 0.0;  // step_: of power_ [Hz]
  std::vector<double> power_;                                    // |S|², from the lowest frequency
  std::vector<double> passes_;                                   // over the shift, the same steps
};

}  // namespace asdic::detail
