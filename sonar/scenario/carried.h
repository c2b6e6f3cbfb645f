#pragma once
#include <cstddef>
#include <vector>

#include "sonar/scenario/scenario.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

/// Something that goes along a track, `offset` from it: an array's reference point or a phone.
struct Carried {
  Track track;
  Vec3 offset = Vec3::Zero();  ///< [m]

  /// \param time  since the start of the scenario [s]
  [[nodiscard]] Kinematics at(double time) const {
    Kinematics place = track.at(time);
    place.position += offset;
    return place;
  }
};

/// An array's reference point, about which plane waves are received: the middle of its phones (of
/// all its shapes; of a towed line, the place on the path at their mean distance behind).
[[nodiscard]] Carried reference_of(const Scenario& scenario, int array);

/// One of its phones. In a turn those of a towed line have each their own velocity. \param ping  of
/// the run, counted from 1: its shape
[[nodiscard]] Carried phone_of(const Scenario& scenario, int array, int ping, int phone);

/// Neighbours among an array's phones: `count` of them from number `first` on.
struct PhoneRange {
  std::size_t first = 0, count = 0;
};

/// The middle of some of its phones, as they lie in a ping.
[[nodiscard]] Carried middle_of(const Scenario& scenario, int array, int ping, PhoneRange phones);

/// Its phones as they lie at a time, from a point that moves. \return [n] [m]
[[nodiscard]] std::vector<Vec3> phones_from(const Carried& point, const Scenario& scenario,
                                            int array, int ping, double time);

/// Whether its phones move against one another while they listen: a towed line that turns.
[[nodiscard]] bool deforms(const Scenario& scenario, int array);

}  // namespace asdic::detail
