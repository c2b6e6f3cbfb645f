#pragma once
#include <vector>

#include "reverb/pairs/receiver_leg.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

/// The legs of a track from a ping on. A return is received on the one on which the middle of its
/// pulse is: the whole pulse with that velocity. \param start  of the ping   \param latest  end of
/// the record, since then \param pulse  duration [s]   \return none if the velocity stays what it
/// is at the start
[[nodiscard]] std::vector<ReceiverLeg> receiver_legs(const Track& track, double start,
                                                     double latest, double pulse);

/// The straight way on which a sender is in the middle of its pulse, as at the ping's start.
[[nodiscard]] Kinematics sent_from(const Track& track, double start, double pulse);

}  // namespace asdic::detail
