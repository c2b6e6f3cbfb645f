#pragma once
#include <complex>

namespace asdic::detail {

class ExactKey;

/// What a projector sends in every direction: complex amplitude, magnitude 1 on the axis.
class TransmitPattern {
 public:
  virtual ~TransmitPattern() = default;

  /// \param bearing  clockwise from north [rad]   \param elevation  positive up [rad]
  [[nodiscard]] virtual std::complex<double> towards(double bearing,
                                                     double elevation) const noexcept = 0;
  /// The same at every bearing: then it is asked once per elevation.
  [[nodiscard]] virtual bool azimuthally_symmetric() const noexcept { return false; }
  /// Adds all that it depends on to a key of what is kept. \return whether it did; what depends on
  /// one that does not is never kept
  [[nodiscard]] virtual bool add_to(ExactKey& /*key*/) const { return false; }
};

}  // namespace asdic::detail
