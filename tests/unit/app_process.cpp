#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/hdf5_file.h"
#include "support/program.h"

namespace asdic {
namespace {

using support::asdic;
using testing::HasSubstr;

class Process : public testing::Test {
 protected:
  Process() {
    static_cast<void>(folder_.write("small.toml", support::small_scenario));
    // A shallow sea that answers from everywhere would hide the target, and of paths that are as
    // loud as each other none can be preferred.
    const std::string quiet =
        "--set reverberation.enabled=false --set target.0.strength_db=25 "
        "--set propagation.max_surface_bounces=0 "
        "--set propagation.max_bottom_bounces=0";
    EXPECT_EQ(asdic(folder_, "ping small.toml -o small.h5 -q " + quiet).status, 0);
  }
  support::TemporaryDirectory folder_;
};

TEST_F(Process, FindsTheTargetAndSaysWhereItIs) {
  const auto done = asdic(folder_, "process small.h5 --target-depth 500m --json --csv tables");
  ASSERT_EQ(done.status, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_EQ(json.at("hits"), 2);
  EXPECT_EQ(json.at("misses"), 0);
  // every detection is somebody's, or a false alarm
  EXPECT_EQ(json.at("detections"), json.at("of_targets").get<int>() + json.at("direct").get<int>() +
                                       json.at("of_other_pings").get<int>() +
                                       json.at("false_alarms").get<int>());
  const auto& target = json.at("pings").at(0).at("targets").at(0);
  EXPECT_TRUE(target.at("hit"));
  // A cell of a 0.1 s tone under Hann's window is 0.05 s, 39 m.
  EXPECT_LT(std::abs(target.at("range_error_m").get<double>()), 20.0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "tables" / "small_detections.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "tables" / "small_tracks.csv"));
  const Hdf5File file = Hdf5File::open(folder_ / "small.h5");
  EXPECT_TRUE(file.has("processed/maps/array_0/beam_time_db"));
  EXPECT_TRUE(file.has("processed/ambiguity/power"));
  EXPECT_EQ(asdic(folder_, "info small.h5").status, 0);
}

TEST_F(Process, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(asdic(folder_, "process small.h5 -o one.h5 --threads 1 -q").status, 0);
  EXPECT_EQ(asdic(folder_, "process small.h5 -o many.h5 --threads 5 -q").status, 0);
  const Hdf5File one = Hdf5File::open(folder_ / "one.h5"),
                 many = Hdf5File::open(folder_ / "many.h5");
  for (const char* name : {"time", "snr_db", "doppler_factor", "level_db", "axis_cosine"}) {
    const std::string dataset = std::string("processed/detections/") + name;
    EXPECT_EQ(one.read<double>(dataset), many.read<double>(dataset)) << name;
  }
}

TEST_F(Process, CanLeaveTheFileAlone) {
  const std::string before = support::content(folder_ / "small.h5");
  const auto done = asdic(folder_, "process small.h5 --no-file");
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("rock"));
  EXPECT_THAT(done.out, HasSubstr("targets that could be heard: 2 found, 0 missed"));
  EXPECT_TRUE(support::content(folder_ / "small.h5") == before);
}

TEST_F(Process, SaysWhatIsWrong) {
  const auto refused = [&](const std::string& words, const std::string& message) {
    const auto done = asdic(folder_, words);
    EXPECT_EQ(done.status, 2) << words;
    EXPECT_THAT(done.err, HasSubstr(message)) << words;
  };
  refused("process none.h5", "no such file");
  refused("process small.toml", "a file that is not HDF5");
  refused("process small.h5 --ping 9", "--ping: found 9, expected a ping from 1 to 2");
  refused("process small.h5 --track-start 4/3", "hits/pings such as 3/4, no more hits than pings");
  refused("process small.h5 --track-start many", "--track-start");
  refused("process small.h5 --elevations 20:-20", "--elevations");
  refused("process small.h5 --beamformer best", "conventional");
  refused("process small.h5 --target-depth deep", "a length such as 60km, 500m or 500");
  refused("process small.h5 --target-depth 9000m", "target_depth: found 9000");
  refused("process small.h5 --target-depth 9000m", "a depth above the sea floor at ");
  refused("process small.h5 --from 3000",
          "--from: found 3000 s, expected a time before the record");
  refused("process small.h5 --false-alarm-probability 2", "--false-alarm-probability");
  refused("process small.h5 -o none/out.h5", "a file in a folder that is there");
}

}  // namespace
}  // namespace asdic
