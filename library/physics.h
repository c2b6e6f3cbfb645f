#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "asdic/watch.h"
#include "library/access.h"
#include "sonar/ping/ping.h"

namespace asdic {

/// What is made of a scenario with a sonar, once: the ocean with what was found in it, the pulses.
class Physics {
 public:
  explicit Physics(const Scenario::Data& data);

  [[nodiscard]] const detail::PingSimulator& simulator() const noexcept { return simulator_; }
  /// The same, its memory asked for and its warnings complete: before pings.
  /// \param watch  its first step, reading, is done
  [[nodiscard]] const detail::PingSimulator& ready_to_ping(const Watch& watch = {});
  /// What is known by now of what to know before trusting a number.
  [[nodiscard]] std::vector<std::string> warnings();

 private:
  detail::PingSimulator simulator_;
  std::mutex mutex_;
  bool judged_ = false;
};

}  // namespace asdic
