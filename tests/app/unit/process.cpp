#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/hdf5/hdf5_file.h"
#include "io/ping/ping_file.h"
#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"
#include "support/program.h"

namespace asdic::detail {
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
  EXPECT_THAT(done.out, HasSubstr("targets: 2 found, 0 missed, 0 not detectable"));
  EXPECT_TRUE(support::content(folder_ / "small.h5") == before);
}

// Every setting that a description has is an option, and stands in the file with what it was.
TEST_F(Process, TellsInTheFileWhatItUsed) {
  const auto used = [&](const std::string& options) {
    const auto done = asdic(folder_, "process small.h5 -o used.h5 -q --force " + options);
    EXPECT_EQ(done.status, 0) << done.err;
    return Hdf5File::open(folder_ / "used.h5").attribute_texts("processed", "options");
  };
  // The pulse is 0.1 s long, its record a sample more.
  EXPECT_THAT(used(""),
              testing::ElementsAre(
                  "beamformer=conventional", "shading=none", "max_speed=15",
                  "normaliser=split-window", "across_beams=true", "guard_cells=2",
                  "reference_cells=12", "false_alarm_probability=1e-06", "cancel_direct_blast=auto",
                  "sub_bands=1", testing::StartsWith("from=0.1"), "track_start=3/4", "track_stop=4",
                  "track_acceleration=0.02", "track_max_speed=15"));
  EXPECT_THAT(
      used("--beamformer mvdr --mvdr-loading-db -3 --shading hann --elevations -20:20.5 "
           "--max-speed 600 --normaliser cell-averaging --time-only --guard-cells 1.5 "
           "--reference-cells 20 --false-alarm-probability 1e-4 --from 0 --until 3 "
           "--cancel-direct-blast off "
           "--target-depth 0.5km --range-speed 1490 --track-start 2/3 --track-stop 5 "
           "--track-acceleration 0.1 --track-max-speed 8"),
      testing::ElementsAre(
          "beamformer=mvdr", "mvdr_loading_db=-3", "shading=hann", "elevations=-20:20.5",
          "max_speed=600", "normaliser=cell-averaging", "across_beams=false", "guard_cells=1.5",
          "reference_cells=20", "false_alarm_probability=0.0001", "cancel_direct_blast=off",
          "sub_bands=1", "from=0", "until=3", "target_depth=500", "range_speed=1490",
          "track_start=2/3", "track_stop=5", "track_acceleration=0.1", "track_max_speed=8"));
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
  refused("process small.h5 --elevations 20:-20",
          "--elevations: found \"20:-20\", expected two angles from -90 to 90 degrees, the lower");
  refused("process small.h5 --elevations up",
          "--elevations: found \"up\", expected two angles such");
  refused("process small.h5 --max-speed 601",
          "--max-speed: found 601, expected a speed from 0 to 600 m/s");
  refused("process small.h5 --beamformer best", "conventional");
  refused("process small.h5 --target-depth deep", "a length such as 60km, 500m or 500");
  refused("process small.h5 --target-depth 9000m", "--target-depth: found 9000");
  refused("process small.h5 --target-depth 9000m", "a depth above the sea floor at ");
  refused("process small.h5 --from 3000",
          "--from: found 3000 s, expected a time before the record");
  refused("process small.h5 --false-alarm-probability 2",
          "--false-alarm-probability: found 2, expected a probability from 1e-30 to 0.5");
  refused("process small.h5 -o none/out.h5", "a file in a folder that is there");
}

// A ping file of a scenario that no file has said, from a program that does not say who it is.
TEST_F(Process, ReadsWhatAProgramMade) {
  Scenario scenario = read_scenario(folder_ / "small.toml", {});
  scenario.text.clear();
  scenario.reverberation.enabled = false;
  scenario.pings.count = 1;
  const PingSimulator simulator(scenario);
  {
    PingFileWriter writer(folder_ / "made.h5", scenario, {});
    writer.append(simulator.simulate(1));
    writer.finish(true);
  }
  const auto done = asdic(folder_, "process made.h5 --json");
  EXPECT_EQ(done.status, 0) << done.err;
  const auto info = asdic(folder_, "info made.h5");
  EXPECT_EQ(info.status, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("made         by a program that does not say"));
}

}  // namespace
}  // namespace asdic::detail
