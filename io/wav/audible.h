#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace asdic::detail {

/// Complex baseband as sound: its carrier becomes a tone that people hear. To listen to, not to
/// measure: the outermost twelfth of the band is weakened.
///
/// y(t) = Re[x(t)·exp(2πi·f·t)], of x interpolated by a windowed sinc to an audible rate. The same
/// bits come out whatever the parts' lengths.
class Audible {
 public:
  /// \param sample_rate  of the baseband [Hz]
  /// \param tone  what its carrier becomes, at least half of that: bands do not overlap [Hz]
  Audible(double sample_rate, double tone);

  [[nodiscard]] double rate() const noexcept { return rate_ * factor_; }  ///< [Hz]
  /// A rate's own tone [Hz].
  [[nodiscard]] static double usual_tone(double sample_rate);

  /// \param baseband  [samples × 2] I and Q in turn
  /// \return what is heard by it: a few samples of the baseband later
  [[nodiscard]] std::vector<float> take(std::span<const float> baseband);
  /// What is left at the end.
  [[nodiscard]] std::vector<float> rest();

 private:
  static constexpr int reach = 32;  // samples of the baseband on either side

  double rate_, tone_;
  int factor_;
  std::vector<float> kernel_;  // [factor × 2·reach]
  std::vector<float> past_;    // I and Q, from sample next_/factor − reach + 1 on
  std::int64_t next_ = 0;      // of what comes out
};

}  // namespace asdic::detail
