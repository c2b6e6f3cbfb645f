#pragma once
#include <vector>

#include "sonar/scenario.h"
#include "sonar/track.h"

namespace asdic {

/// Where something is from a moment on: straight ahead, and straight on from each turn.
struct Passage {
  Vec3 position = Vec3::Zero();  ///< at that moment [m]
  Vec3 velocity = Vec3::Zero();  ///< then [m/s]

  struct Turn {
    double time = 0.0;  ///< after that moment [s]
    Kinematics from;    ///< place and new velocity
  };
  std::vector<Turn> turns{};  ///< rising in time

  Passage() = default;
  Passage(const Kinematics& start)
      : position(start.position), velocity(start.velocity) {}  // NOLINT

  [[nodiscard]] Kinematics at(double time) const;
  [[nodiscard]] Vec3 after(double time) const { return at(time).position; }
};

/// The passage of an array's reference point from a time on, with the waypoints of its platform.
/// \param time  since the start of the scenario [s]
[[nodiscard]] Passage passage_of_array(const Scenario& scenario, int array, double time);

}  // namespace asdic
