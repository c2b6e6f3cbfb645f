#pragma once
#include <vector>

#include "sonar/scenario/scenario.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail::serve {

/// The schedule of a scenario, going on for ever: whose turn it is, and when. A ping that is sent
/// at another time moves those of its transmitter after it.
class PingSchedule {
 public:
  explicit PingSchedule(const Scenario& scenario);

  /// The next ping of the schedule. The first ones are those of transmissions().
  [[nodiscard]] Transmission next(const Scenario& scenario) const;
  /// The next ping of one transmitter.
  [[nodiscard]] Transmission next(const Scenario& scenario, int transmitter) const;
  /// \param moved  its time is not the schedule's
  void sent(const Transmission& one, bool moved);

 private:
  struct Anchor {
    int own_ping = 1;   // that is sent …
    double time = 0.0;  // … then; later ones follow at the interval
    int next = 1;       // turn
  };
  std::vector<Anchor> anchors_;  // [transmitters]
};

}  // namespace asdic::detail::serve
