#pragma once
#include <cstddef>
#include <vector>

#include "sonar/scenario/scenario.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

class ExactKey;

/// Something that goes along a track, `offset` from it: a transmitter, an array's reference point
/// or a phone.
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
void add_to(ExactKey& key, const Carried& carried);

/// A transmitter on the way of its platform.
[[nodiscard]] Carried sender_of(const Scenario& scenario, int transmitter);

/// Neighbours among an array's phones: `count` of them from number `first` on.
struct PhoneRange {
  std::size_t first = 0, count = 0;
};

/// Where an array's phones are at any time: worked out once, for who asks by time and not by ping
/// (noise, ships) and for a ping's PingGeometry. The scenario must outlive it. Pings are those of
/// the run, counted from 1: each has its shape. Times count from the start of the scenario [s].
class ArrayMotion {
 public:
  ArrayMotion(const Scenario& scenario, int array);

  [[nodiscard]] const ReceiverArray& array() const noexcept { return *array_; }
  [[nodiscard]] const Track& carrier() const noexcept { return *carrier_; }
  /// The point about which plane waves are received: the middle of its phones (of all its shapes;
  /// of a towed line, the place on the path at their mean distance behind).
  [[nodiscard]] const Carried& reference() const noexcept { return reference_; }
  [[nodiscard]] Kinematics at(double time) const { return reference_.at(time); }
  /// Its phones as they lie then, from the reference point at that time. [n] [m]
  [[nodiscard]] std::vector<Vec3> phones(int ping, double time) const;
  /// The same from another point that moves. [n] [m]
  [[nodiscard]] std::vector<Vec3> phones_from(const Carried& point, int ping, double time) const;
  /// One of them. In a turn those of a towed line have each their own velocity.
  [[nodiscard]] Carried phone(int ping, int phone) const;
  /// The middle of some of them, as they lie in a ping.
  [[nodiscard]] Carried middle_of(int ping, PhoneRange phones) const;
  /// Whether they move against one another while they listen: a towed line that turns.
  [[nodiscard]] bool deforms() const noexcept;

 private:
  const ReceiverArray* array_;
  const Track* carrier_;
  Carried reference_;
};

/// Those of all arrays.
[[nodiscard]] std::vector<ArrayMotion> array_motions(const Scenario& scenario);

}  // namespace asdic::detail
