#include <gtest/gtest.h>

#include "io/scenario/scenario_reader.h"
#include "support/listen.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// When the strongest pair of unreflected paths is received, from the eigenrays and nothing else.
double echo_time(const Scenario& s, double range) {
  const EigenraySolver solver(s.environment);
  const double depth = s.targets[0].track.start.position.z();
  const Arrivals there = solver.find(4500.0, depth, range, 4000.0, {0, 0});
  return there.empty() ? 0.0 : 2.0 * there[0].delay;
}

// 5.2.4: "we start a simulation assuming one target at 25 km; once there has been one ping, another
// target is simulated at 30 km". In the pressure: a Hann pulse of 1 s has its top at its middle,
// flat to 0.1 dB over ±50 ms; paths by the surface come 20 ms later at most, reverberation and
// noise move the top some more: ±0.15 s, against 6 s between the echoes.
TEST(ThesisTwoTargets, TheSecondAppearsAtTheSecondPing) {
  const Scenario s = read_scenario(std::string(ASDIC_SCENARIOS) + "/two_targets.toml");
  const PingSimulator simulator(s);
  const double near = echo_time(s, 25000.0), far = echo_time(s, 30000.0);
  ASSERT_GT(near, 30.0);
  ASSERT_GT(far, near + 5.0);
  double level[3][2];
  for (const int ping : {1, 2}) {
    const PingRecord record = simulator.simulate(ping);
    const Baseband received = support::demodulate(record, 4000.0, 8.0);
    const auto row = support::broadside(received);
    const auto first = support::peak(received, row, near - 1.0, near + 2.0);
    const auto second = support::peak(received, row, far - 1.0, far + 2.0);
    EXPECT_NEAR(first.time, near + 0.5, 0.15);
    if (ping == 2) {
      EXPECT_NEAR(second.time, far + 0.5, 0.15);
    }
    level[ping][0] = first.level_db;
    level[ping][1] = second.level_db;
    // Nothing else is as loud: between the echoes there is silence.
    EXPECT_LT(support::peak(received, row, near + 2.5, far - 1.0).level_db, first.level_db - 10.0);
  }
  // The first target has not changed (1 dB: reverberation 20 dB down), the second is new.
  EXPECT_NEAR(level[1][0], level[2][0], 1.0);
  EXPECT_GT(level[2][1], level[1][1] + 15.0);
  RecordProperty("second_rises_db", std::to_string(level[2][1] - level[1][1]));
}

}  // namespace
}  // namespace asdic::detail
