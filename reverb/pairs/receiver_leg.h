#pragma once
#include <algorithm>
#include <vector>

#include "core/kinematics.h"

namespace asdic::detail {

/// A straight segment of a receiver's track: what is received on it is received as if the receiver
/// had always been on it.
struct ReceiverLeg {
  double until = 0.0;  ///< leading edges of a smaller delay since the ping are received on it [s]
  Kinematics line;     ///< where it would have been at the ping's start
};

/// The leg on which a leading edge of that delay is received. \param legs  at least one
[[nodiscard]] inline const ReceiverLeg& leg_at(const std::vector<ReceiverLeg>& legs,
                                               double delay) noexcept {
  const auto after =
      std::upper_bound(legs.begin(), legs.end() - 1, delay,
                       [](double t, const ReceiverLeg& leg) { return t < leg.until; });
  return *after;
}

}  // namespace asdic::detail
