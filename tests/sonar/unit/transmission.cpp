#include "sonar/scenario/transmission.h"

#include <gtest/gtest.h>

#include "sonar/scenario/scenario.h"

namespace asdic::detail {
namespace {

// Two transmitters take turns; pings on command may be of either, whatever their number.
TEST(ProjectorOf, ARecordedPingIsTheOneThatItsFileNames) {
  Scenario s;
  s.pings.count = 2;
  s.pings.interval = 10.0;
  s.pings.elevations = {0.1, 0.2};
  s.transmitters = {Transmitter{.elevation = 0.5}, Transmitter{.elevation = -0.5}};
  s.transmitters[1].first_ping_time = 5.0;
  s.transmitters[0].source_level_db = 200.0;
  s.transmitters[1].source_level_db = 180.0;

  // Sent: transmitter 0 at 0 s, 1 at 5 s, 0 at 10 s, 1 at 15 s.
  EXPECT_EQ(projector_of(s, 0, 3).elevation, 0.2);
  EXPECT_EQ(projector_of(s, 0, 3).source_level_db, 200.0);
  // The third, and one beyond the schedule, sent on command by the other one.
  for (const int ping : {3, 7}) {
    EXPECT_EQ(projector_of(s, 1, ping).elevation, -0.5) << ping;
    EXPECT_EQ(projector_of(s, 1, ping).source_level_db, 180.0) << ping;
  }
}

}  // namespace
}  // namespace asdic::detail
