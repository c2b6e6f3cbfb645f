#pragma once
#include <limits>

namespace asdic::detail {

/// How many bounces are followed off either boundary, and an estimate of how much of the level is
/// missing for it [dB].
struct Bounces {
  int surface = 0, bottom = 0;
  double left_out_db = std::numeric_limits<double>::quiet_NaN();  ///< none: not a number

  /// The more of both.
  void include(const Bounces& other) noexcept;
};

}  // namespace asdic::detail
