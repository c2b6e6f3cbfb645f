#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/ping/ping_file.h"
#include "support/left_of.h"
#include "support/program.h"

// The commands beside `asdic ping`: what they print and what they write.

namespace asdic::detail {
namespace {

using nlohmann::json;
using support::asdic;

class Commands : public ::testing::Test {
 protected:
  void SetUp() override { static_cast<void>(folder.write("small.toml", support::small_scenario)); }
  support::TemporaryDirectory folder;
};

TEST_F(Commands, AllHaveHelpWithAnExampleAndAVersion) {
  for (const char* name :
       {"", "bellhop", "convert", "explain", "ping", "rays", "arrivals", "validate", "info", "plot",
        "export", "ocean", "compare", "field", "settings", "help"}) {
    const auto help = asdic(folder, std::string(name) + " --help");
    EXPECT_EQ(help.status, 0) << name;
    EXPECT_EQ(help.err, "") << name;
    EXPECT_THAT(help.out, testing::ContainsRegex("Examples?: +asdic ")) << name;
    const auto version = asdic(folder, std::string(name) + " --version");
    EXPECT_EQ(version.status, 0) << name;
    EXPECT_TRUE(version.out.starts_with("asdic ")) << version.out;
  }
}

TEST_F(Commands, ValidateSaysWhatItUnderstood) {
  const auto run = asdic(folder, "validate small.toml --set pings.count=10");
  EXPECT_EQ(run.status, 0) << run.err;
  for (const char* part : {"small sea", "1000 m deep", "1500.00 to 1500.00 m/s", "2 phones", "rock",
                           "range 3.000 km, bearing 90.0 deg", "10 pings", "20000 samples",
                           "1.8 MB", "small.toml: good"})
    EXPECT_NE(run.out.find(part), std::string::npos) << part << " is not in:\n" << run.out;
}

// Straight rays at 1500 m/s: time is length over speed, and each bounce turns the ray over.
TEST_F(Commands, RaysOfAnIsovelocitySeaAreStraight) {
  const auto run = asdic(folder, "rays small.toml --elevations -10,0,30 --range 5km --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json all = json::parse(run.out);
  EXPECT_EQ(all["filetype"], "asdic rays");
  EXPECT_EQ(all["source_depth"], 200.0);
  ASSERT_EQ(all["rays"].size(), 3U);
  for (const json& ray : all["rays"]) {
    const double length = ray["path_length"], time = ray["travel_time"],
                 elevation = ray["launch_elevation_deg"];
    EXPECT_NEAR(length, 5000.0 / std::cos(elevation * M_PI / 180.0), 1e-6 * length);
    EXPECT_NEAR(time, length / 1500.0, 1e-9 * time);
  }
  // 30 degrees up from 200 m: the surface at 200/tan 30° = 346.4 m, every 2000/tan 30° from there.
  const std::vector<double> hits = all["rays"][2]["surface_hits"];
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_NEAR(hits[0], 346.410, 1e-3);
  EXPECT_NEAR(hits[1], 346.410 + 3464.102, 1e-3);
}

TEST_F(Commands, RaysTableAndFile) {
  const auto table = asdic(folder, "rays small.toml --from 0 --to 10 --count 3");
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_EQ(std::count(table.out.begin(), table.out.end(), '\n'), 2 + 3) << table.out;
  ASSERT_EQ(asdic(folder, "rays small.toml --count 5 -o rays.h5").status, 0);
  const Hdf5File file = Hdf5File::open(folder / "rays.h5");
  EXPECT_EQ(file.attribute_text("", "filetype"), "asdic rays");
  EXPECT_EQ(file.read<double>("rays/launch_elevation_deg"),
            (std::vector<double>{-20.0, -10.0, 0.0, 10.0, 20.0}));
  EXPECT_EQ(file.info("rays/depth").shape, file.info("rays/range").shape);
  EXPECT_EQ(support::left_of(folder / "rays.h5"), "");
  EXPECT_EQ(asdic(folder, "convert rays.h5 rays.ray").status, 0);
  EXPECT_THAT(asdic(folder, "info rays.ray").out, testing::HasSubstr("frequency  1000 Hz"));
}

// The direct path: √(3000² + 300²) m; delay at 1500 m/s, spherical spreading, no absorption.
// 1e-6 dB is far above rounding and far below any term of the sonar equation.
TEST_F(Commands, ArrivalsOfAnIsovelocitySea) {
  const auto run = asdic(folder, "arrivals small.toml --leg target --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json all = json::parse(run.out);
  EXPECT_EQ(all["filetype"], "asdic arrivals");
  ASSERT_EQ(all["legs"].size(), 1U);
  const json& leg = all["legs"][0];
  EXPECT_EQ(leg["target_name"], "rock");
  EXPECT_NEAR(leg["bearing_deg"].get<double>(), 90.0, 1e-9);
  const json& direct = leg["arrivals"][0];
  const double slant = std::hypot(3000.0, 300.0);
  EXPECT_NEAR(direct["delay"].get<double>(), slant / 1500.0, 1e-9);
  EXPECT_NEAR(direct["level_db"].get<double>(), -20.0 * std::log10(slant), 1e-6);
  EXPECT_NEAR(direct["launch_elevation_deg"].get<double>(), -std::atan2(300.0, 3000.0) * 180 / M_PI,
              1e-7);
  const json& surface = leg["arrivals"][1];  // image at −200 m
  EXPECT_NEAR(surface["delay"].get<double>(), std::hypot(3000.0, 700.0) / 1500.0, 1e-9);
  ASSERT_EQ(surface["bounces"].size(), 1U);
  EXPECT_EQ(surface["bounces"][0]["boundary"], "surface");
  EXPECT_NEAR(surface["bounces"][0]["grazing_deg"].get<double>(),
              std::atan2(700.0, 3000.0) * 180 / M_PI, 1e-7);
  EXPECT_NEAR(std::abs(surface["phase_deg"].get<double>()), 180.0, 1e-9);
}

TEST_F(Commands, ArrivalsAtAnyDepthAndRange) {
  const auto run = asdic(folder, "arrivals small.toml --receiver-depth 500m --range 3km --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json free = json::parse(run.out)["legs"][0]["arrivals"];
  const json target = json::parse(asdic(folder, "arrivals small.toml --leg target --json").out);
  EXPECT_EQ(free, target["legs"][0]["arrivals"]);  // where the target is
}

// Below a surface duct: by waves, or off the bottom. Munk's first caustic: one of two.
TEST_F(Commands, ArrivalsTellOfWhatKindTheyAre) {
  const std::string duct =
      "arrivals small.toml --source-depth 10m --receiver-depth 100m --range 10km --frequency 500 "
      "--set 'environment.sound_speed={kind=\"table\", depth=[0, 60, 160, 1000], "
      "speed=[1510, 1510.96, 1500.96, 1490], interpolation=\"c-linear\"}'";
  const auto run = asdic(folder, duct + " --json");
  ASSERT_EQ(run.status, 0) << run.err;
  int diffracted = 0, rays = 0;
  const json all = json::parse(run.out);
  for (const json& path : all["legs"][0]["arrivals"]) {
    (path["kind"] == "diffracted" ? diffracted : rays) += 1;
    if (path["kind"] == "diffracted") {
      EXPECT_NEAR(path["level_db"].get<double>(), -88.0, 1.0);
    }
  }
  EXPECT_EQ(diffracted, 1);
  EXPECT_GT(rays, 0);
  EXPECT_THAT(asdic(folder, duct).out, testing::HasSubstr("diffracted"));

  const auto caustic = asdic(folder,
                             "arrivals small.toml --source-depth 1000m --receiver-depth 700m "
                             "--range 41300m --frequency 100 --set "
                             "'environment.sound_speed={kind=\"munk\"}' --set "
                             "environment.bottom.depth=5000 --json");
  ASSERT_EQ(caustic.status, 0) << caustic.err;
  EXPECT_THAT(caustic.out, testing::HasSubstr("\"kind\": \"caustic\""));
}

// One truth: the tables of `asdic arrivals -o` are those that `asdic ping` writes.
TEST_F(Commands, ArrivalsFileIsThePingFilesTable) {
  ASSERT_EQ(asdic(folder, "ping small.toml -q --pings 1").status, 0);
  ASSERT_EQ(asdic(folder, "arrivals small.toml -o arrivals.h5").status, 0);
  const Hdf5File ping = Hdf5File::open(folder / "small.h5"),
                 arrivals = Hdf5File::open(folder / "arrivals.h5");
  EXPECT_EQ(arrivals.attribute_text("", "filetype"), "asdic arrivals");
  int columns = 0;
  for (const DatasetInfo& dataset : ping.datasets()) {
    if (!dataset.path.starts_with("/arrivals/") && !dataset.path.starts_with("/bounces/")) continue;
    ++columns;
    ASSERT_TRUE(arrivals.has(dataset.path)) << dataset.path;
    EXPECT_EQ(arrivals.info(dataset.path).type, dataset.type) << dataset.path;
    auto ours = arrivals.read<double>(dataset.path), theirs = ping.read<double>(dataset.path);
    if (dataset.path == "/arrivals/bearing_deg")  // of one circle: -90 is 270
      for (double& bearing : theirs) bearing = bearing < 0.0 ? bearing + 360.0 : bearing;
    EXPECT_EQ(ours, theirs) << dataset.path;
    if (ping.has_attribute(dataset.path, "units")) {
      EXPECT_EQ(arrivals.attribute_text(dataset.path, "units"),
                ping.attribute_text(dataset.path, "units"));
    }
  }
  EXPECT_GE(columns, 22 + 3);
}

TEST_F(Commands, InfoShowsWhatAFileHolds) {
  ASSERT_EQ(asdic(folder, "ping small.toml -q --seed 11 --time-axis").status, 0);
  EXPECT_EQ(Hdf5File::open(folder / "small.h5").info("time").shape, Shape{20000});
  const auto run = asdic(folder, "info small.h5");
  EXPECT_EQ(run.status, 0) << run.err;
  for (const char* part :
       {"small sea", "complete", "2 pings, 2 phones, 20000 samples at 4000 Hz: 5 s", "cw, 1000 Hz",
        "seed 11", "rock", "asdic 0."})
    EXPECT_NE(run.out.find(part), std::string::npos) << part << " is not in:\n" << run.out;
  EXPECT_LE(std::count(run.out.begin(), run.out.end(), '\n'), 24);  // one screen
}

TEST_F(Commands, InfoReadsResultsOfEveryKind) {
  ASSERT_EQ(asdic(folder, "arrivals small.toml -o arrivals.h5").status, 0);
  ASSERT_EQ(asdic(folder, "rays small.toml -o rays.h5").status, 0);
  ASSERT_EQ(asdic(folder, "convert arrivals.h5 a.arr -q").status, 0);
  const auto says = [&](const std::string& file, const std::string& part) {
    const auto run = asdic(folder, "info " + file);
    EXPECT_EQ(run.status, 0) << file << ": " << run.err;
    EXPECT_NE(run.out.find(part), std::string::npos) << part << " is not in:\n" << run.out;
  };
  says("arrivals.h5", "small sea");
  says("arrivals.h5", "frequency  1000 Hz");
  says("rays.h5", "rays       41, launched at -20 to 20 deg");
  says("a.arr", "arrivals");
  const auto toml = asdic(folder, "info small.toml");
  EXPECT_EQ(toml.status, 2);
  EXPECT_NE(toml.err.find("small.toml: found a file that is not HDF5, expected"), std::string::npos)
      << toml.err;
}

TEST_F(Commands, ExportWritesAWavFileAPing) {
  ASSERT_EQ(asdic(folder, "ping small.toml -q").status, 0);
  const auto run = asdic(folder, "export small.h5 --wav -o sounds/here");
  EXPECT_EQ(run.status, 0) << run.err;
  for (const char* name : {"small_ping001.wav", "small_ping002.wav"}) {
    const auto path = folder / "sounds/here" / name;
    // two channels of 20000 samples of four bytes, and a header
    EXPECT_GE(std::filesystem::file_size(path), 160000U);
    EXPECT_LT(std::filesystem::file_size(path), 160000U + 1000U);
    EXPECT_TRUE(std::filesystem::exists(path.string() + ".json"));
  }
  const auto none = asdic(folder, "export small.h5 --wav --ping 3");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("expected a ping from 1 to 2"), std::string::npos);
}

TEST_F(Commands, SettingsTellsTypeRangeAndDefault) {
  const auto text = asdic(folder, "settings measure.receiver");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("  max_speed: 0 to 600 m/s [15]\n"), std::string::npos) << text.out;
  const auto table = asdic(folder, "settings --markdown measure.receiver");
  EXPECT_NE(
      table.out.find("| `mvdr_loading_db` | -120 to 60 dB | `-10` | diagonal loading, re the mean "
                     "power of a phone (`beamformer = \"mvdr\"`) |\n"),
      std::string::npos)
      << table.out;
  const auto all = asdic(folder, "settings --markdown");
  EXPECT_NE(all.out.find("## reverberation\n"), std::string::npos);
  EXPECT_EQ(all.out.find("|  |\n"), std::string::npos) << "every setting says what it is";
  const auto wrong = asdic(folder, "settings recievers");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("SECTION: found \"recievers\", expected one that is described: "),
            std::string::npos)
      << wrong.err;
}

TEST_F(Commands, SettingsTellsATableWithinASection) {
  const auto surface = asdic(folder, "settings reverberation.surface");
  EXPECT_EQ(surface.status, 0) << surface.err;
  EXPECT_NE(surface.out.find("[reverberation.surface] of scenario: what the surface scatters\n"),
            std::string::npos)
      << surface.out;
  EXPECT_NE(surface.out.find("  gamma2: 2 to 6 [3.9]\n"), std::string::npos) << surface.out;
  EXPECT_EQ(surface.out.find("mu_db"), std::string::npos) << "that is of the bottom";
  const auto highlight = asdic(folder, "settings --markdown target.highlight");
  EXPECT_NE(highlight.out.find("| `offset` | 3 numbers, -1000 to 1000 m | required |"),
            std::string::npos)
      << highlight.out;
}

// A default that a file need not know is told in words: it is none of its values.
TEST_F(Commands, SettingsTellWhatHoldsWithoutAKey) {
  const auto row = [&](const std::string& section, const std::string& key) {
    const std::string all = asdic(folder, "settings --markdown " + section).out;
    const auto begin = all.find("| `" + key + "` |");
    return begin == std::string::npos ? all : all.substr(begin, all.find('\n', begin) - begin);
  };
  EXPECT_EQ(
      row("noise", "sea_state"),
      "| `sea_state` | 0 to 6 | of the wind | in place of the wind's (`kind = \"knudsen\"`) |");
  EXPECT_EQ(row("target", "last_ping"),
            "| `last_ping` | whole, at least 1 | no end | to which it is there |");
  EXPECT_EQ(row("transmitter", "beamwidth_deg"),
            "| `beamwidth_deg` | 0.01 to 179 degrees | required | full width at -3 dB of the line "
            "when it is not steered (`kind = \"line\", taper = \"hann\" or \"rectangular\"`); a "
            "running server takes changes |");
  EXPECT_EQ(row("target", "scan_pings").find("| `scan_pings` | whole, 1 to 1000000 | required |"),
            0U);
  EXPECT_NE(row("target", "scan_pings").find("`fluctuation = \"swerling-1\" or \"swerling-3\"`"),
            std::string::npos);
  EXPECT_EQ(row("run", "memory")
                .find("| `memory` | 1000000 to 1e+18 bytes, or a text: \"4 GB\" | "
                      "half of what the process may have |"),
            0U)
      << row("run", "memory");
  EXPECT_NE(row("pulse", "sample_rate").find("`kind = \"file\", with samples`"), std::string::npos);
  EXPECT_NE(row("pulse", "duration").find("`kind other than \"file\"`"), std::string::npos);
  EXPECT_NE(row("environment.bottom", "shear_speed").find("| `1000` |"), std::string::npos);
}

TEST_F(Commands, ValidateTellsEverySettingAsItWasUnderstood) {
  const auto all = asdic(folder, "validate small.toml --all --set pulse.window=hann");
  EXPECT_EQ(all.status, 0) << all.err;
  const auto has = [&](const std::string& line) {
    return ("\n" + all.out).find("\n" + line + "\n") != std::string::npos;
  };
  EXPECT_TRUE(has("pulse.window = \"hann\"")) << all.out;
  EXPECT_TRUE(has("propagation.max_surface_bounces = 1")) << all.out;
  EXPECT_TRUE(has("propagation.max_launch_angle_deg = 90 degrees (default)")) << all.out;
  EXPECT_TRUE(has("pings.interval = 10 s")) << all.out;
  EXPECT_TRUE(has("pings.elevations_deg = those of the transmitters (default)")) << all.out;
  const auto wrong = asdic(folder, "validate small.toml --all --set pulse.windw=hann");
  EXPECT_EQ(wrong.status, 2);
}

TEST_F(Commands, SettingsAreASchemaForEditors) {
  const json scenario = json::parse(asdic(folder, "settings --schema").out);
  const json& surface = scenario["properties"]["reverberation"]["properties"]["surface"];
  EXPECT_EQ(surface["type"], "object");
  const json& kind = surface["properties"]["kind"];
  EXPECT_EQ(kind["enum"], (json{"nrl", "chapman-harris", "ogden-erskine", "table"}));
  EXPECT_EQ(kind["default"], "nrl");
  const json& gamma2 = surface["properties"]["gamma2"];
  EXPECT_EQ(gamma2["type"], "number");
  EXPECT_EQ(gamma2["minimum"], 2.0);
  EXPECT_EQ(gamma2["maximum"], 6.0);
  EXPECT_EQ(gamma2["default"], 3.9);
  EXPECT_FALSE(scenario["properties"].contains("measure"));  // those are of studies
  const json study = json::parse(asdic(folder, "settings --schema measure.receiver").out);
  EXPECT_EQ(study["properties"]["measure"]["properties"]["receiver"]["properties"]
                 ["false_alarm_probability"]["minimum"],
            1e-30);
}

TEST_F(Commands, LengthsAreTakenInKilometresAndMetres) {
  const auto of = [&](const std::string& range) {
    return asdic(folder, "rays small.toml --count 2 --range " + range).out;
  };
  EXPECT_EQ(of("2.5km"), of("2500"));
  EXPECT_EQ(of("2500m"), of("2500"));
  EXPECT_EQ(of("'2.5 km'"), of("2500"));
  EXPECT_NE(of("2.6km"), of("2500"));
}

}  // namespace
}  // namespace asdic::detail
