#pragma once
#include <complex>

namespace asdic {

/// What a projector sends in every direction: complex amplitude, magnitude 1 on the axis.
class TransmitPattern {
 public:
  virtual ~TransmitPattern() = default;

  /// \param bearing  clockwise from north [rad]   \param elevation  positive up [rad]
  [[nodiscard]] virtual std::complex<double> towards(double bearing,
                                                     double elevation) const noexcept = 0;
  /// The same at every bearing: then it is asked once per elevation.
  [[nodiscard]] virtual bool all_round() const noexcept { return false; }
};

}  // namespace asdic
