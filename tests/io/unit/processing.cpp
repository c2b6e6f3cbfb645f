#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/own_files.h"
#include "io/ping/ping_file.h"
#include "io/processing/recordings.h"
#include "io/processing/results.h"
#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"
#include "sonar/ping/run_pings.h"
#include "support/left_of.h"
#include "support/program.h"

namespace asdic::detail {
namespace {

/// A ping file of the small scenario, two pings.
std::filesystem::path ping_file(const support::TemporaryDirectory& folder) {
  const std::filesystem::path path = folder / "small.h5";
  const PingSimulator simulator(parse_scenario(support::small_scenario, "small.toml"));
  PingFileWriter writer(path, simulator.scenario(), {});
  run_pings(simulator, [&](PingRecord&& record) { writer.append(record); });
  writer.finish(true);
  return path;
}

ProcessedRun some_run() {
  ProcessedRun run;
  ProcessedPing ping;
  ping.array.result.detections = {{.ping = 1,
                                   .time = 1.25,
                                   .doppler = 1.001,
                                   .cosine = 0.5,
                                   .bearing = radians(60.0),
                                   .elevation = std::nan(""),
                                   .snr_db = 20.0,
                                   .locations = {{.position = {10.0, 20.0, 30.0}, .range = 22.0}}}};
  ping.score.owner = {0};
  run.pings = {ping};
  run.options = {"shading=none"};
  run.maps = false;
  return run;
}

Replica tone() {
  return Replica(std::span<const float>(replica(
                     Pulse({.waveform = Cw{.frequency = 1000.0}, .duration = 0.1}), 4000.0)),
                 4000.0);
}

TEST(PingRecordingsTest, ReadWhatWasWritten) {
  const support::TemporaryDirectory folder;
  const PingRecordings file(ping_file(folder));
  ASSERT_EQ(file.pings(), 2U);
  EXPECT_EQ(file.number(1), 2);
  EXPECT_EQ(file.row_of(2), 1U);
  EXPECT_THROW(static_cast<void>(file.row_of(3)), InputError);
  const ArrayRecording r = file.recording(1, 0);
  const PingFile plain(folder / "small.h5");
  const std::vector<float> second = plain.pressure(1, 1);
  ASSERT_EQ(r.pressure.size(), 2 * second.size());
  EXPECT_TRUE(
      std::equal(second.begin(), second.end(), r.pressure.begin() + std::ptrdiff_t(second.size())));
  EXPECT_EQ(r.phones.size(), 2U);
  EXPECT_NEAR((r.phones[1] - r.phones[0]).norm(), 0.75, 1e-9);
  // √(3000² + 300²)/1500·2 is the straight pair's delay
  const auto echoes = file.echoes(0, 0);
  ASSERT_FALSE(echoes.empty());
  double first = infinity;
  for (const TrueEcho& e : echoes) first = std::min(first, e.time);
  EXPECT_NEAR(first, 2.0 * std::hypot(3000.0, 300.0) / 1500.0, 1e-6);
  EXPECT_EQ(file.targets(0, echoes).at(0).name, "rock");
  ASSERT_EQ(file.replicas().size(), 1U);
  EXPECT_NEAR(file.replicas()[0].centre_frequency(), 1000.0, 1.0);
}

/// The small scenario, its samples told otherwise, without what hides the target.
std::filesystem::path other_file(const support::TemporaryDirectory& folder,
                                 const std::string& old_line, const std::string& new_line) {
  std::string text = support::small_scenario;
  if (const auto at = text.find(old_line); at != std::string::npos)
    text.replace(at, old_line.size(), new_line);
  const std::vector<std::string> quiet{"reverberation.enabled=false", "target.0.strength_db=30",
                                       "propagation.max_surface_bounces=0",
                                       "propagation.max_bottom_bounces=0"};
  const std::filesystem::path path = folder / "other.h5";
  const PingSimulator simulator(parse_scenario(text, "small.toml", quiet));
  PingFileWriter writer(path, simulator.scenario(), {});
  run_pings(simulator, [&](PingRecord&& record) { writer.append(record); });
  writer.finish(true);
  return path;
}

/// The loudest detection of the first ping.
Detection loudest(const std::filesystem::path& path) {
  const PingRecordings file(path);
  ProcessingSettings settings{.target_depth = 500.0};
  settings.detector.first_time = 0.2;
  const PingProcessor processor(file.scenario(), file.replicas(), settings);
  const auto found = processor.process(file.recording(0, 0)).result.detections;
  return found.empty() ? Detection{}
                       : *std::max_element(found.begin(), found.end(),
                                           [](auto& a, auto& b) { return a.snr_db < b.snr_db; });
}

// Complex baseband holds what passband holds, but its noise is another draw. At 44 dB of SNR noise
// moves an amplitude by 0.45 %, 0.04 dB, each time: four deviations of the difference are 0.22 dB;
// the time by a hundredth of the cell of 50 ms. The background is a mean of 24 cells, 20 % or 0.9
// dB: four deviations of the difference are 5 dB.
TEST(PingRecordingsTest, BasebandIsProcessedLikePassband) {
  const support::TemporaryDirectory folder;
  const Detection passband = loudest(other_file(folder, "no such line", ""));
  std::string rate_line = support::small_scenario;
  rate_line = rate_line.substr(rate_line.find("sample_rate"));
  rate_line = rate_line.substr(0, rate_line.find('\n'));
  const std::filesystem::path path = other_file(folder, rate_line, "samples = \"baseband\"");
  ASSERT_EQ(Hdf5File::open(path).info("pressure").shape.size(), 4U);
  const Detection baseband = loudest(path);
  ASSERT_EQ(passband.locations.size(), 2U);
  ASSERT_EQ(baseband.locations.size(), 2U);
  EXPECT_NEAR(baseband.time, passband.time, 0.5e-3);
  EXPECT_NEAR(baseband.locations[0].range, passband.locations[0].range, 0.5);
  EXPECT_NEAR(baseband.level_db, passband.level_db, 0.22);
  EXPECT_NEAR(baseband.snr_db, passband.snr_db, 5.0);
}

// In a continuous record a ping is listened to into the rows of the next: its echo at 4.02 s comes
// after the next ping at 3 s.
TEST(PingRecordingsTest, AContinuousRecordIsListenedToAcrossPings) {
  const support::TemporaryDirectory folder;
  const std::filesystem::path path =
      other_file(folder, "interval = 10.0", "interval = 3.0\ncontinuous = true");
  const PingRecordings file(path);
  EXPECT_NEAR(file.end(0), 5.0, 1e-2);
  const double delay = 2.0 * std::hypot(3000.0, 300.0) / 1500.0;
  EXPECT_NEAR(loudest(path).time, delay, 5e-3);
  // The second ping receives that echo 3 s earlier, and knows whose it is.
  const auto echoes = file.echoes(1, 0);
  const auto other = std::find_if(echoes.begin(), echoes.end(),
                                  [](const TrueEcho& e) { return e.target == another_ping; });
  ASSERT_NE(other, echoes.end());
  EXPECT_NEAR(other->time, delay - 3.0, 1e-3);
  EXPECT_TRUE(
      std::any_of(echoes.begin(), echoes.end(), [](const TrueEcho& e) { return e.target == 0; }));
}

TEST(PingRecordingsTest, OtherFilesAreInputErrors) {
  const support::TemporaryDirectory folder;
  EXPECT_THROW(PingRecordings(folder / "none.h5"), InputError);
  static_cast<void>(folder.write("text.h5", "no HDF5"));
  EXPECT_THROW(PingRecordings(folder / "text.h5"), InputError);
  { Hdf5File other = Hdf5File::create(folder / "other.h5"); }
  EXPECT_THROW(PingRecordings(folder / "other.h5"), InputError);
}

OutputFile to(const std::filesystem::path& path) { return OutputFile(path, {.own = own::hdf5}); }

TEST(WriteProcessed, KeepsTheDataAndReplacesEarlierResults) {
  const support::TemporaryDirectory folder;
  const std::filesystem::path path = ping_file(folder);
  const auto before = Hdf5File::open(path).read<float>("pressure");
  const auto names = Hdf5File::open(path).datasets().size();
  ProcessedRun run = some_run();
  write_processed(path, to(path), run, tone());
  {
    const Hdf5File file = Hdf5File::open(path);
    EXPECT_TRUE(file.read<float>("pressure") == before);
    EXPECT_EQ(file.read<double>("processed/detections/time"), std::vector{1.25});
    EXPECT_EQ(file.read<double>("processed/detections/x"), std::vector{10.0});
    EXPECT_TRUE(std::isnan(file.read<double>("processed/detections/mirror_x")[0]));
    EXPECT_EQ(file.attribute_texts("processed", "options"),
              std::vector<std::string>{"shading=none"});
    EXPECT_FALSE(file.has("processed/maps"));
    EXPECT_GT(file.datasets().size(), names);
  }
  const auto size = std::filesystem::file_size(path);
  run.pings[0].array.result.detections.clear();
  run.pings[0].score.owner.clear();
  for (int i = 0; i < 5; ++i) write_processed(path, to(path), run, tone());
  EXPECT_TRUE(Hdf5File::open(path).read<double>("processed/detections/time").empty());
  EXPECT_LT(std::filesystem::file_size(path), size + 200000);  // it does not grow without end
  EXPECT_EQ(support::left_of(path), "");
}

TEST(WriteProcessed, LeavesTheInputAloneWhenAnotherFileIsWritten) {
  const support::TemporaryDirectory folder;
  const std::filesystem::path path = ping_file(folder);
  const std::string before = support::content(path);
  write_processed(path, to(folder / "other.h5"), some_run(), tone());
  EXPECT_TRUE(support::content(path) == before);
  EXPECT_TRUE(Hdf5File::open(folder / "other.h5").has("processed/detections/time"));
}

TEST(WriteProcessed, CannotBeWrittenIsToldAndLeavesTheInput) {
  const support::TemporaryDirectory folder;
  const std::filesystem::path path = ping_file(folder);
  const std::string before = support::content(path);
  EXPECT_THROW(write_processed(path, to(folder / "none" / "out.h5"), some_run(), tone()),
               InputError);
  EXPECT_TRUE(support::content(path) == before);
}

TEST(DetectionsCsv, HasALineARow) {
  const std::string text = detections_csv(some_run());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_EQ(text.substr(0, 16), "ping,array,time,");
  EXPECT_EQ(text.substr(text.find('\n') + 1, 14), "1,0,1.25,1.001");
}

}  // namespace
}  // namespace asdic::detail
