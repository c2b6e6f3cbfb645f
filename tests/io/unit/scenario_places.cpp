#include <gtest/gtest.h>

#include "core/error.h"
#include "io/ping/ping_file.h"
#include "support/ping_record.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::small_record;
using support::small_scenario;

/// The small sea with a hill to 20 m below the surface, 4 km east of the platform.
std::vector<std::string> hill(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "environment.transect={bearing_deg=90}",
      "environment.bottom={kind=\"rigid\", shape={range=[0, 2000, 4000, 6000], "
      "depth=[5000, 5000, 20, 5000], interpolation=\"piecewise-linear\"}}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

std::string fault(const std::vector<std::string>& overrides) {
  try {
    static_cast<void>(small_scenario(overrides));
  } catch (const InputError& error) {
    return error.what();
  }
  return "good";
}

// Half way up the hill the sea is 2510 m deep: a target at 2500 m is in the water there, 30 m
// further on it is not; nor anywhere along the hill, far from the transect.
TEST(Places, EverythingIsInTheWaterOfItsOwnPlace) {
  EXPECT_EQ(fault(hill({"target.0.position=[3000, 0, 2500]"})), "good");
  EXPECT_EQ(fault(hill({"target.0.position=[3030, 0, 2500]"})),
            "--set target.0.position: found depth 2500 m at 0 s, expected a depth "
            "between the surface (0 m) and the bottom (2435.3 m) there, 3030 m along the transect");
  EXPECT_EQ(fault(hill({"target.0.position=[2990, 9000, 2500]"})), "good");
  EXPECT_NE(fault(hill({"target.0.position=[3030, 9000, 2500]"})), "good");
}

// What a slope mirrors back does not lie in the vertical plane through transmitter and array.
TEST(Places, AFathometerIsReceivedOverLevelGroundOnly) {
  EXPECT_TRUE(small_scenario({"propagation.fathometer=true"}).propagation.fathometer);
  EXPECT_EQ(fault(hill({"propagation.fathometer=true"})),
            "--set propagation.fathometer: found true, expected false where the ocean varies along "
            "a transect, or propagation.dimension = 3: a mirror that slopes is not in the plane of "
            "transmitter and array");
  EXPECT_EQ(fault(hill({"propagation.fathometer=true", "propagation.dimension=3"})), "good");
}

// Rays in three dimensions know a flat surface only.
TEST(Places, ThreeDimensionsRefuseASurfaceThatIsNotFlat) {
  const std::string swell = "environment.surface={shape={range=[0, 100, 200], depth=[0, 1, 0]}}";
  EXPECT_EQ(fault(hill({swell})), "good");
  EXPECT_EQ(
      fault(hill({swell, "propagation.dimension=3"})),
      "--set propagation.dimension: found 3, expected 2: rays in three dimensions know a flat "
      "surface only, and environment.surface has a shape");
}

// A straight track over the top, in 70 m of water at both ends.
TEST(Places, TracksAreLookedAtAllAlong) {
  const auto at_depth = [](int depth) {
    const std::string z = std::to_string(depth);
    return "target=[{strength_db=15, waypoints=[{time=0, position=[3980, 0, " + z +
           "]}, {time=0.5, position=[4020, 0, " + z + "]}]}]";
  };
  EXPECT_EQ(fault(hill({at_depth(15)})), "good");
  const std::string message = fault(hill({at_depth(25)}));
  EXPECT_NE(message.find("found depth 25 m"), std::string::npos) << message;
  EXPECT_NE(message.find("the bottom (20 m) there, 4000 m along the transect"), std::string::npos)
      << message;
}

TEST(Places, PhonesAreLookedAtWhereTheyAre) {
  EXPECT_EQ(fault(hill({"array={kind=\"positions\", positions=[[0, 0, 0], [3900, 0, 100]]}"})),
            "--set array: array.positions: found phone 1 at depth 1100 m at 0 s, expected a depth "
            "between the "
            "surface (0 m) and the bottom (269 m) there, 3900 m along the transect");
}

// The file says what the ocean was, where it lay, and what the rays were drawn over.
TEST(Places, PingFilesHoldTheTransect) {
  const support::TemporaryDirectory folder;
  const Scenario scenario = small_scenario(hill());
  {
    PingFileWriter writer(folder / "p.h5", scenario, {});
    writer.write_rays(
        {.paths = {{.launch_elevation = 0.0, .range = {0.0, 9.0}, .depth = {5.0, 5.0}}},
         .bearing = radians(45.0),
         .bottom = {.range = {0.0, 9.0}, .depth = {1000.0, 900.0}}});
    writer.append(small_record(scenario, 1));
    writer.finish(true);
  }
  const PingFile ping(folder / "p.h5");
  const Hdf5File& file = ping.file();
  EXPECT_EQ(file.read<double>("environment/bottom_range"),
            (std::vector{0.0, 2000.0, 4000.0, 6000.0}));
  EXPECT_EQ(file.read<double>("environment/bottom_depth"),
            (std::vector{5000.0, 5000.0, 20.0, 5000.0}));
  EXPECT_EQ(file.attribute_text("environment/bottom_depth", "interpolation"), "piecewise-linear");
  EXPECT_EQ(file.attribute_number("environment", "transect_bearing_deg"), 90.0);
  EXPECT_EQ(file.attribute_number("environment", "bottom_depth_m"), 5000.0);
  EXPECT_EQ(file.read<double>("rays/bottom_depth"), (std::vector{1000.0, 900.0}));
  EXPECT_NEAR(file.attribute_number("rays", "bearing_deg"), 45.0, 1e-12);
}

// 3 to 3.4 where kHz were meant is half a sweep of 3 Hz.
TEST(Pulses, WhoseBandReachesZeroAreNoted) {
  const auto notes_of = [](const std::string& sweep) {
    return small_scenario({"pulse={kind=\"lfm\", duration=0.4, window=\"hann\", " + sweep + "}",
                           "pings.recording_duration=5"})  // the echo arrives within the record
        .notes;
  };
  EXPECT_TRUE(notes_of("start_frequency=300, end_frequency=340").empty());
  const auto notes = notes_of("start_frequency=3, end_frequency=3.4");
  ASSERT_EQ(notes.size(), 2U);  // Thorp's law does not reach down there either
  EXPECT_NE(notes[1].find("Hz wide about 3.2 Hz, reaches down to 0 Hz: frequencies are in Hz"),
            std::string::npos)
      << notes[1];
}

}  // namespace
}  // namespace asdic::detail
