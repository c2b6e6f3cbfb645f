#pragma once
#include <vector>

#include "sonar/scenario/carried.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail {

/// Where everything is, and how it moves, while one ping sounds: worked out once, for all parts of
/// the ping to ask. The scenario must outlive it. Times count from the ping's leading edge [s],
/// places are the scenario's [m].
class PingGeometry {
 public:
  /// \param ping  of the run, counted from 1: the shape of its arrays
  PingGeometry(const Scenario& scenario, const Transmission& sent, int ping);

  [[nodiscard]] const Scenario& scenario() const noexcept { return *scenario_; }
  [[nodiscard]] const Transmission& sent() const noexcept { return sent_; }
  [[nodiscard]] int ping() const noexcept { return ping_; }
  /// Of the leading edge, since the start of the scenario [s].
  [[nodiscard]] double time() const noexcept { return sent_.time; }

  [[nodiscard]] const Transmitter& transmitter() const noexcept { return *transmitter_; }
  /// It on the way of its platform.
  [[nodiscard]] const Carried& sender() const noexcept { return sender_; }
  /// When its leading edge leaves, and later.
  [[nodiscard]] const Kinematics& source() const noexcept { return source_; }
  [[nodiscard]] Kinematics source_at(double since) const { return sender_.at(time() + since); }
  /// Course of the platform that carries it, when the leading edge leaves [rad].
  [[nodiscard]] double source_heading() const noexcept { return source_heading_; }

  [[nodiscard]] const ReceiverArray& array(int index) const noexcept;
  /// Whether the transmitter's own platform carries it.
  [[nodiscard]] bool is_own(int array) const noexcept;
  /// Where its phones are at any time.
  [[nodiscard]] const ArrayMotion& motion(int array) const noexcept;
  /// Its reference point, and its place when the leading edge leaves.
  [[nodiscard]] const Carried& reference(int array) const noexcept;
  [[nodiscard]] const Kinematics& reference_place(int array) const noexcept;
  /// Its phones from there, as they lie then. [n] [m]
  [[nodiscard]] const std::vector<Vec3>& phones(int array) const noexcept;
  /// The same from another point that moves. [n] [m]
  [[nodiscard]] std::vector<Vec3> phones_from(const Carried& point, int array) const;
  /// The middle of some of them.
  [[nodiscard]] Carried middle_of(int array, PhoneRange phones) const;
  /// Who receives at one of its phones; −1: at its reference point.
  [[nodiscard]] Carried receiver(int array, int phone) const;
  /// The point about which the array receives reverberation. The transmitter's own place, where it
  /// lies within a quarter of a wavelength of the phones' middle and stays there: then sound comes
  /// back along the paths that it went out on, and in phase. Elsewhere the reference point.
  /// \param frequency  [Hz]
  [[nodiscard]] Carried reverberation_point(int array, double frequency) const;

  [[nodiscard]] Kinematics target_at(int target, double since) const;

 private:
  struct Listener {
    ArrayMotion motion;
    Kinematics place;
    std::vector<Vec3> phones;  // from the reference point
  };
  [[nodiscard]] const Listener& listener(int array) const noexcept;

  const Scenario* scenario_;
  Transmission sent_;
  int ping_;
  const Transmitter* transmitter_;
  Carried sender_;
  Kinematics source_;
  double source_heading_;
  std::vector<Listener> listeners_;  // [arrays]
};

}  // namespace asdic::detail
