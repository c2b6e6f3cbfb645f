#pragma once
#include <complex>
#include <vector>

#include "core/units.h"

namespace asdic::detail {

/// One sparse return: what reaches the array along one path from one echo or one scatterer.
///
/// A phone at x receives Re{amplitude · s₊(doppler·(t − τ))}, τ = delay + slowness·(x − reference)
/// (a plane wave).
struct Return {
  double delay =
      0.0;  ///< of the leading edge at the array's reference point, from the ping's start [s]
  std::complex<double> amplitude = 0.0;  ///< pressure at the phone over peak pressure of the pulse
                                         ///< at 1 m; carrier phase of `delay` not included
  double doppler = 1.0;                  ///< η: frequency × η, duration ÷ η
  Vec3 slowness = Vec3::Zero();  ///< direction of travel at the array over the local sound speed,
                                 ///< over 1 − s·v for an array that
                                 ///< moves [s/m]
  int channel =
      all_channels;  ///< the one phone that receives it (exact per-phone eigenrays), or all of them

  static constexpr int all_channels = -1;
};

using Returns = std::vector<Return>;

}  // namespace asdic::detail
