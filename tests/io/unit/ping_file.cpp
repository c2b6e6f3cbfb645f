#include "io/ping/ping_file.h"
#include "io/files/digest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>

#include "core/error.h"
#include "io/hdf5/scale.h"
#include "io/text/csv_table.h"
#include "support/left_of.h"
#include "support/ping_record.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::small_record;
using support::small_scenario;
using support::TemporaryDirectory;
using testing::HasSubstr;

const Provenance provenance{.program_version = "0.1", .build = "g++", .host = "here"};

// The two vectors of FIPS 180-2, appendix B.
TEST(Sha256, MatchesThePublishedVectors) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(PingFile, GivesBackWhatWasWritten) {
  const TemporaryDirectory folder;
  const std::vector<std::string> overrides{"pings.count=2", "transmitter.elevation_deg=8"};
  const Scenario scenario = small_scenario(overrides);
  {
    PingFileWriter writer(folder / "p.h5", scenario, provenance);
    writer.write_rays({.paths = {{.launch_elevation = radians(3.0),
                                  .range = {0.0, 10.0, 20.0},
                                  .depth = {1000.0, 990.0, 980.0}},
                                 {.kind = RayPaths::Kind::eigenray,
                                  .range = {0.0, 10.0},
                                  .depth = {1000.0, 1001.0}}},
                       .hit_range = {12345.0}});
    writer.append(small_record(scenario, 1));
    writer.append(small_record(scenario, 2));
    EXPECT_FALSE(std::filesystem::exists(folder / "p.h5"));
    writer.finish(true);
  }
  EXPECT_EQ(support::left_of(folder / "p.h5"), "");
  const PingFile file(folder / "p.h5");
  EXPECT_EQ(file.pings(), 2U);
  EXPECT_EQ(file.channels(), 4U);
  EXPECT_EQ(file.samples(), 2000U);
  EXPECT_EQ(file.sample_rate(), 4000.0);
  EXPECT_TRUE(file.complete());
  EXPECT_EQ(file.scenario_text(), scenario.text);
  const PingRecord second = small_record(scenario, 2);
  const auto pressure = file.pressure(1, 3);
  ASSERT_EQ(pressure.size(), 2000U);
  for (std::size_t i = 0; i < 2000; ++i) EXPECT_EQ(pressure[i], second.pressure[3 * 2000 + i]);
  const auto summary = file.summary(1);
  ASSERT_EQ(summary.size(), 1U);
  EXPECT_EQ(summary[0].name, "one, and only");
  EXPECT_EQ(summary[0].echo_level_db, 90.0);

  const Hdf5File& h5 = file.file();
  EXPECT_EQ(h5.attribute_text("", "scenario_sha256"), sha256(scenario.text));
  EXPECT_EQ(h5.attribute_texts("", "overrides"), overrides);
  EXPECT_EQ(h5.read<std::int32_t>("arrivals/ping"), (std::vector<std::int32_t>{1, 1, 2, 2}));
  EXPECT_EQ(h5.read<std::int32_t>("arrivals/first_bounce"),
            (std::vector<std::int32_t>{-1, 0, -1, 1}));
  EXPECT_NEAR(h5.read<double>("arrivals/spreading_db")[0], 60.0, 1e-9);
  EXPECT_NEAR(h5.read<double>("echoes/arrival_elevation_deg")[0], -5.0, 1e-9);
  EXPECT_NEAR(h5.read<double>("echoes/arrival_bearing_deg")[0], 270.0, 1e-9);
  EXPECT_EQ(h5.info("patches/range").shape[0], 2U * 1500);  // every third of 4500
  EXPECT_EQ(h5.attribute_number("patches", "every"), 3.0);
  const auto ground = h5.read<std::int32_t>("patches/boundary");  // a third of each
  EXPECT_EQ(std::count(ground.begin(), ground.end(), 0), 1000);
  EXPECT_EQ(std::count(ground.begin(), ground.end(), 1), 1000);
  EXPECT_EQ(ground[999], 1);
  EXPECT_EQ(ground[1000], 2);
  const auto depth = h5.read<double>("rays/depth");
  ASSERT_EQ(depth.size(), 6U);
  EXPECT_TRUE(std::isnan(depth[5]));
  EXPECT_THROW(static_cast<void>(file.pressure(2, 0)), InputError);
  EXPECT_THROW(static_cast<void>(file.pressure(0, 4)), InputError);
}

// What pictures of the record ask for: how wide the pulse sweeps, whatever it is called.
TEST(PingFile, TellsHowWideItsPulseSweeps) {
  const TemporaryDirectory folder;
  const auto swept = [&](const AnyWaveform& waveform) {
    Scenario scenario = small_scenario();
    scenario.pulse.waveform = waveform;
    PingFileWriter(folder / "p.h5", scenario, provenance, SampleTimes::start_and_step).finish(true);
    const double width = Hdf5File::open(folder / "p.h5").attribute_number("replica", "sweep_hz");
    std::filesystem::remove(folder / "p.h5");
    return width;
  };
  EXPECT_EQ(swept(Cw{1000.0}), 0.0);
  EXPECT_EQ(swept(Lfm{1050.0, 950.0}), 100.0);
  EXPECT_EQ(swept(Hfm{900.0, 1100.0}), 200.0);
  std::vector<double> tone(800);
  for (std::size_t i = 0; i < tone.size(); ++i) tone[i] = std::sin(0.25 * pi * double(i));
  EXPECT_TRUE(std::isnan(swept(SampledPulse{.samples = tone, .sample_rate = 8000.0})));
}

// Start and step tell the same times as the axis that takes their place; the dimension takes no
// room: all of the file's growth is the axes, 8 bytes a time.
TEST(PingFile, TimesAreStartAndStepOrWrittenOut) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  for (const auto& [name, times] : {std::pair{"told.h5", SampleTimes::start_and_step},
                                    std::pair{"axis.h5", SampleTimes::written_out}}) {
    PingFileWriter writer(folder / name, scenario, provenance, times);
    writer.append(small_record(scenario, 1));
    writer.finish(true);
  }
  const Hdf5File told = Hdf5File::open(folder / "told.h5"),
                 axis = Hdf5File::open(folder / "axis.h5");
  for (const auto& [dataset, dimension, coordinate] :
       {std::array{"pressure", "sample", "time"},
        std::array{"replica", "replica_sample", "replica_time"},
        std::array{"levels/echo", "levels/interval", "levels/level_time"}}) {
    EXPECT_TRUE(told.has(dimension) && !told.has(coordinate)) << dataset;
    EXPECT_TRUE(axis.has(coordinate) && !axis.has(dimension)) << dataset;
    const double start = told.attribute_number(dataset, "time_start"),
                 step = told.attribute_number(dataset, "time_step");
    const auto written = axis.read<double>(coordinate);
    ASSERT_EQ(told.info(dimension).shape, Shape{written.size()}) << dataset;
    ASSERT_EQ(told.info(dataset).shape.back(), written.size()) << dataset;
    for (std::size_t k = 0; k < written.size(); ++k)
      ASSERT_NEAR(written[k], start + double(k) * step, 1e-9 * step) << dataset << ' ' << k;
    EXPECT_EQ(time_of_first(told, dataset, coordinate), written.front()) << dataset;
  }
  EXPECT_DOUBLE_EQ(told.attribute_number("pressure", "time_step"), 1.0 / 4000.0);
  EXPECT_LT(std::filesystem::file_size(folder / "told.h5") + 8 * 2000,
            std::filesystem::file_size(folder / "axis.h5"));
}

TEST(PingFile, TimesOfFilesOfVersionOneAreThoseOfTheirAxis) {
  const TemporaryDirectory folder;
  Hdf5File file = Hdf5File::create(folder / "old.h5");
  write_scale<double>(file, "time", "sample", {0.5, 0.75, 1.0}, "after the start of the ping", "s");
  file.write<float>("pressure", std::vector<float>(3), {3});
  EXPECT_EQ(time_of_first(file, "pressure", "time"), 0.5);
}

TEST(PingFile, VersionsOneToThreeAreRead) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  const auto path = folder / "p.h5";
  PingFileWriter writer(path, scenario, provenance);
  writer.append(small_record(scenario, 1));
  writer.finish(true);
  for (const auto& [version, good] : {std::pair{"1.0", true}, std::pair{"2.7", true},
                                      std::pair{"3.1", true}, std::pair{"4.0", false}}) {
    {
      Hdf5File file = Hdf5File::edit(path);
      file.set_attribute("", "version", version);
      file.close();
    }
    if (good)
      EXPECT_NO_THROW(static_cast<void>(PingFile(path))) << version;
    else
      EXPECT_THROW(static_cast<void>(PingFile(path)), InputError) << version;
  }
}

TEST(PingFile, EveryDatasetSaysWhatItIsAndHasAxes) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  PingFileWriter writer(folder / "p.h5", scenario, provenance);
  writer.append(small_record(scenario, 1));
  writer.finish(true);
  const Hdf5File file = Hdf5File::open(folder / "p.h5");
  const auto datasets = file.datasets();
  EXPECT_GT(datasets.size(), 80U);
  for (const DatasetInfo& dataset : datasets) {
    EXPECT_TRUE(file.has_attribute(dataset.path, "long_name")) << dataset.path;
    EXPECT_NE(dataset.type, ElementType::other) << dataset.path;
    const bool scale = file.has_attribute(dataset.path, "CLASS");
    EXPECT_TRUE(dataset.shape.empty() || scale ||
                file.has_attribute(dataset.path, "DIMENSION_LIST"))
        << dataset.path;
  }
}

TEST(PingFile, IsReadableAfterEveryPingEvenIfTheProgramDies) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  const auto path = folder / "p.h5";
  EXPECT_EXIT(
      {
        PingFileWriter writer(path, scenario, provenance);
        writer.append(small_record(scenario, 1));
        std::_Exit(0);  // no destructor, nothing flushed on the way out
      },
      testing::ExitedWithCode(0), "");
  ASSERT_EQ(parts_of(path).size(), 1U);
  const PingFile file(parts_of(path).front());
  EXPECT_EQ(file.pings(), 1U);
  EXPECT_FALSE(file.complete());
  EXPECT_EQ(file.pressure(0, 1).front(), small_record(scenario, 1).pressure[2000]);
}

TEST(PingFile, UnfinishedFilesStayOnlyIfTheyHoldAPing) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  { const PingFileWriter writer(folder / "a.h5", scenario, provenance); }
  {
    PingFileWriter writer(folder / "b.h5", scenario, provenance);
    writer.finish(false);
  }
  {
    PingFileWriter writer(folder / "c.h5", scenario, provenance);
    writer.append(small_record(scenario, 1));
  }
  {
    PingFileWriter writer(folder / "d.h5", scenario, provenance);
    writer.append(small_record(scenario, 1));
    writer.finish(false);
  }
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         testing::MatchesRegex("c\\.h5\\.[0-9a-z]{4}\\.part"), "d.h5"));
  EXPECT_FALSE(PingFile(folder / "d.h5").complete());
}

TEST(PingFile, FoldersThatAreNotThereAreNamed) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  try {
    const PingFileWriter writer(folder / "none/p.h5", scenario, provenance);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no folder \"" + (folder / "none").string() + '"'));
  }
}

// A limit on the size of files stands for a full disk: write() fails the same way.
TEST(PingFile, AFullDiskIsARunErrorThatSaysSo) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  const auto path = folder / "p.h5";
  EXPECT_EXIT(
      {
        signal(SIGXFSZ, SIG_IGN);
        rlimit limit{};
        limit.rlim_cur = limit.rlim_max = 300'000;
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
          PingFileWriter writer(path, scenario, provenance);
          for (int ping = 1; ping < 100; ++ping) writer.append(small_record(scenario, ping));
          writer.finish(true);
        } catch (const RunError& error) {
          std::fprintf(stderr, "%s\n", error.what());
          // Not exit(): threads that other tests have started are not in this copy of the process.
          std::_Exit(std::filesystem::exists(path) ? 3 : 1);
        }
        std::_Exit(0);
      },
      testing::ExitedWithCode(1),
      "p.h5.[0-9a-z]*.part: .*failed: File too large \\(HDF5: file write failed\\)");
}

TEST(PingFile, OtherFilesAreInputErrors) {
  const TemporaryDirectory folder;
  const Scenario scenario = small_scenario();
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      const PingFile file(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "read without complaint";
  };
  EXPECT_THAT(message(folder / "none.h5"), HasSubstr("none.h5: found no such file, expected an"));
  EXPECT_THAT(message(folder.write("text.h5", "hello")), HasSubstr("a file that is not HDF5"));
  EXPECT_THAT(message(folder.write("empty.h5", "")),
              HasSubstr("found an empty file, expected an HDF5 file"));
  {
    PingFileWriter writer(folder / "p.h5", scenario, provenance);
    writer.append(small_record(scenario, 1));
    writer.finish(true);
  }
  const std::string bytes = read_text_file(folder / "p.h5");
  const auto cut = folder.write("cut.h5", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(message(cut),
              HasSubstr("cut.h5: found a file that cannot be opened (truncated file"));
  {
    Hdf5File other = Hdf5File::create(folder / "other.h5");
    other.set_attribute("", "filetype", "statepoint");
    other.close();
  }
  EXPECT_THAT(message(folder / "other.h5"), HasSubstr("found filetype \"statepoint\", expected"));
}

}  // namespace
}  // namespace asdic::detail
