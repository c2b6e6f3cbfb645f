#pragma once
#include <algorithm>
#include <vector>

#include "sonar/scenario/track.h"

namespace asdic {

/// A straight stretch of a receiver's track: what is heard on it is heard as if the receiver had
/// always been on it.
struct ReceiverLeg {
  double until = 0.0;  ///< leading edges of a smaller delay since the ping are heard on it [s]
  Kinematics line;     ///< where it would have been at the ping's start
};

/// The leg on which a leading edge of that delay is heard. \param legs  at least one
[[nodiscard]] inline const ReceiverLeg& leg_at(const std::vector<ReceiverLeg>& legs,
                                               double delay) noexcept {
  const auto after =
      std::upper_bound(legs.begin(), legs.end() - 1, delay,
                       [](double t, const ReceiverLeg& leg) { return t < leg.until; });
  return *after;
}

/// The legs of a track from a ping on. A return is heard on the one on which the middle of its
/// pulse is: the whole pulse with that velocity. \param start  of the ping   \param latest  end of
/// the record, since then \param pulse  duration [s]   \return none if the velocity stays what it
/// is at the start
[[nodiscard]] std::vector<ReceiverLeg> receiver_legs(const Track& track, double start,
                                                     double latest, double pulse);

/// The straight way on which a sender is in the middle of its pulse, as at the ping's start.
[[nodiscard]] Kinematics sent_from(const Track& track, double start, double pulse);

}  // namespace asdic
