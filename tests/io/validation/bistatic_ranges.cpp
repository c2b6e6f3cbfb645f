// scenarios/bistatic.toml: what a delay means in range where sender and array are 12 km apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry.h"
#include "io/scenario/scenario_reader.h"
#include "processing/localiser.h"
#include "sonar/ping/ping.h"
#include "sonar/scenario/ping_bounds.h"

namespace asdic::detail {
namespace {

// The submarine's loudest pair of paths, from the simulator's own truth: along the bearing of the
// place where it was struck, seen from where the array received it, the delay's range is that
// place's. Between nodes 110 m apart T(r) bends by T″h²/8 < h²/(8·1500·7000) = 0.15 ms, 0.2 m; the
// array moves by 4 m/s times what a straight ray's delay is off, some hundredths of a second: 1 m.
// Half the delay times 1500 m/s, what a map of one place would say, is 600 m off.
TEST(BistaticScenario, ADelayIsTheRangeOfItsPlaceAlongTheBearing) {
  const PingSimulator simulator(read_scenario(
      ASDIC_SCENARIOS "/bistatic.toml", std::vector<std::string>{"reverberation.enabled=false"}));
  const Scenario& s = simulator.scenario();
  const PingRecord record = simulator.simulate(1);
  ASSERT_FALSE(record.echoes.empty());
  const EchoPath& loudest = *std::max_element(
      record.echoes.begin(), record.echoes.end(),
      [](const EchoPath& a, const EchoPath& b) { return a.level_db < b.level_db; });
  const double delay = loudest.received.delay;
  const SonarPlaces places{.source = transmitter_at(s, 0, 0.0),
                           .array = {.start = array_at(s, 0, 0.0), .waypoints = {}}};
  const Vec3 received = places.array.at(delay).position;
  // Struck on the way: by the share that the leg out has in the two straight ways.
  Vec3 struck = s.targets[0].track.at(0.5 * delay).position;
  for (int i = 0; i < 3; ++i) {
    const double out = (struck - places.source.position).norm(), back = (struck - received).norm();
    struck = s.targets[0].track.at(delay * out / (out + back)).position;
  }
  const Separation truth = separation(received, struck);

  const PropagationPaths paths(s.environment, s.transect);
  const Localiser localiser(paths, {.frequency = 1500.0,
                                    .propagation = s.propagation,
                                    .depth = s.targets[0].track.at(0.0).position.z()});
  const std::vector<double> times{delay - 0.05, delay, delay + 0.05, 18.0};
  const std::vector<double> ranges = localiser.ranges(truth.bearing, times, places);
  EXPECT_NEAR(ranges[1], truth.range, 2.0);
  EXPECT_GT(std::abs(ranges[1] - 750.0 * delay), 500.0);
  EXPECT_LT(ranges[0], ranges[1]);
  EXPECT_LT(ranges[1], ranges[2]);
  // Before sound can come from there, on that bearing, there is no range.
  EXPECT_TRUE(std::isnan(localiser.ranges(truth.bearing, std::vector<double>{1.0}, places)[0]));
}

}  // namespace
}  // namespace asdic::detail
