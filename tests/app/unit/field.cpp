#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/result/field_file.h"
#include "io/result/result_file.h"
#include "raytrace/cases/beam_error_text.h"
#include "support/left_of.h"
#include "support/program.h"

// asdic field, and asdic rays and arrivals of an ocean and a run without a sonar.

namespace asdic::detail {
namespace {

using nlohmann::json;
using support::asdic;

/// A half space of water without a floor in reach: only the direct path and its image over the
/// surface arrive.
constexpr const char* lloyd_mirror = R"(title = "under the surface"
[environment]
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 4000.0
kind = "fluid"
speed = 1500.0
density = 1027.0
attenuation_db_per_wavelength = 0.0
[environment.absorption]
kind = "none"
[run]
task = "field"
frequency = 100.0
[run.source]
depth = 40.0
[run.receivers]
depth = [60.0, 100.0]
range = { first = 500.0, last = 1500.0, count = 11 }
[run.fan]
lowest_deg = -60.0
highest_deg = 60.0
)";

class FieldCommand : public ::testing::Test {
 protected:
  void SetUp() override { static_cast<void>(folder.write("mirror.toml", lloyd_mirror)); }
  support::TemporaryDirectory folder;
};

/// e^{−ikr}/r from the source, less the same from its image.
std::complex<double> mirror(double range, double depth) {
  const double k = 2.0 * M_PI * 100.0 / 1500.0;
  const double direct = std::hypot(range, depth - 40.0), image = std::hypot(range, depth + 40.0);
  return std::polar(1.0 / direct, -k * direct) - std::polar(1.0 / image, -k * image);
}

// Straight rays: no beams but the two paths themselves, in float32; the bottom is beyond the fan.
TEST_F(FieldCommand, WritesTheFieldOfTheScenario) {
  const auto run = asdic(folder, "field mirror.toml -o mirror.h5 --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json summary = json::parse(run.out);
  EXPECT_EQ(summary["receivers"], 22);
  EXPECT_EQ(summary["beam_kind"], "hat");
  EXPECT_EQ(summary["beams"], 0);
  ASSERT_EQ(summary["notes"].size(), 1U);
  EXPECT_NE(summary["notes"][0].get<std::string>().find("up to 2 images"), std::string::npos);
  const FieldData field = read_field(folder / "mirror.h5");
  EXPECT_EQ(field.title, "under the surface");
  ASSERT_EQ(field.pressure.size(), 22U);
  for (std::size_t i = 0; i < 22; ++i) {
    const std::complex<double> exact =
        mirror(field.receivers.ranges[i % 11], field.receivers.depths[i / 11]);
    EXPECT_LT(std::abs(std::complex<double>(field.pressure[i]) - exact), 1e-6 * std::abs(exact));
  }
  EXPECT_EQ(support::left_of(folder / "mirror.h5"), "");
}

TEST_F(FieldCommand, TheFileTellsOfItself) {
  ASSERT_EQ(asdic(folder, "field mirror.toml -q --set run.beams.kind=gaussian").status, 0);
  const Hdf5File file = Hdf5File::open(folder / "mirror.h5");
  EXPECT_EQ(file.attribute_text("", "filetype"), "asdic field");
  EXPECT_EQ(file.attribute_text("", "beam_kind"), "gaussian");
  EXPECT_EQ(file.attribute_text("", "overrides"), "run.beams.kind=gaussian");
  EXPECT_EQ(file.read_text("scenario"), lloyd_mirror);
  EXPECT_EQ(file.info("pressure").shape, (Shape{1, 2, 11, 2}));
  for (const DatasetInfo& dataset : file.datasets())
    EXPECT_TRUE(file.has_attribute(dataset.path, "long_name")) << dataset.path;
  EXPECT_EQ(file.read<double>("environment/bottom_depth").front(), 4000.0);
}

/// A run over a slope, where beams are needed and few can be sure.
constexpr const char* slope = R"([environment.sound_speed]
kind = "table"
depth = [0.0, 300.0]
speed = [1500.0, 1490.0]
[environment.bottom]
kind = "fluid"
speed = 1700.0
density = 1800.0
[environment.bottom.shape]
range = [0.0, 5000.0]
depth = [200.0, 50.0]
[run]
frequency = 200.0
[run.source]
depth = 50.0
[run.receivers]
depth = { first = 10.0, last = 190.0, count = 19 }
range = { first = 100.0, last = 4000.0, count = 40 }
[run.fan]
lowest_deg = -40.0
highest_deg = 40.0
)";

// How many receivers are sure of the number of beams is the same in what is printed, in the file,
// in what is told of the file and in its dataset; a file without beams says nothing of it.
TEST_F(FieldCommand, TellsHowSureItIs) {
  static_cast<void>(folder.write("slope.toml", slope));
  const auto run = asdic(folder, "field slope.toml -o slope.h5");
  ASSERT_EQ(run.status, 0) << run.err;
  const FieldData field = read_field(folder / "slope.h5");
  ASSERT_EQ(field.beam_errors.size(), 19U * 40U);
  const double share = share_sure(field.beam_errors);
  EXPECT_GT(share, 0.1);
  const std::string line = "certain    " + certainty_text(share) + '\n';
  EXPECT_NE(run.out.find(line), std::string::npos) << run.out;
  const std::string told = asdic(folder, "info slope.h5").out;
  EXPECT_NE(told.find(line), std::string::npos) << told;
  EXPECT_NE(told.find("\nbeams      "), std::string::npos) << told;
  const Hdf5File file = Hdf5File::open(folder / "slope.h5");
  EXPECT_NEAR(file.attribute_number("", "sure_pct"), 100.0 * share, 1e-9);
  EXPECT_EQ(file.attribute_text("beam_error", "units"), "dB");
  EXPECT_EQ(file.info("beam_error").shape, (Shape{1, 19, 40}));
  EXPECT_TRUE(std::isnan(field.beam_errors[18 * 40 + 39])) << "190 m is below 80 m of water";
  const json summary = json::parse(asdic(folder, "field slope.toml --force --json").out);
  EXPECT_NEAR(summary["sure_pct"].get<double>(), 100.0 * share, 1e-9);

  ASSERT_EQ(asdic(folder, "field mirror.toml -q").status, 0);
  const Hdf5File images = Hdf5File::open(folder / "mirror.h5");
  EXPECT_FALSE(images.has("beam_error"));
  EXPECT_FALSE(images.has_attribute("", "sure_pct"));
  EXPECT_TRUE(
      json::parse(asdic(folder, "field mirror.toml --force --json").out)["sure_pct"].is_null());
}

TEST_F(FieldCommand, AShadeFileHoldsTheSameField) {
  ASSERT_EQ(asdic(folder, "field mirror.toml -q -o a.h5").status, 0);
  ASSERT_EQ(asdic(folder, "field mirror.toml -q -o a.shd").status, 0);
  const auto run = asdic(folder, "compare a.h5 a.shd --max-p95 1e-9 --max-error 1e-6");
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

TEST_F(FieldCommand, ThreadsDoNotChangeABit) {
  ASSERT_EQ(asdic(folder, "field mirror.toml -q -o one.h5 --threads 1").status, 0);
  ASSERT_EQ(asdic(folder, "field mirror.toml -q -o four.h5 --threads 4").status, 0);
  EXPECT_EQ(read_field(folder / "one.h5").pressure, read_field(folder / "four.h5").pressure);
}

// Arrivals at every receiver; their sum at the frequency is the exact field.
TEST_F(FieldCommand, ArrivalsOfARunAddUpToTheField) {
  ASSERT_EQ(asdic(folder, "arrivals mirror.toml -o mirror.h5").status, 0);
  ASSERT_EQ(asdic(folder, "arrivals mirror.toml -o mirror.arr").status, 0);
  EXPECT_EQ(
      asdic(folder, "compare mirror.h5 mirror.arr --min-matched 100 --max-delay-us 0.1").status, 0);
  const auto file = std::get<bellhop::ArrivalsFile>(read_result(folder / "mirror.h5"));
  ASSERT_EQ(file.arrivals.size(), 22U);
  for (std::size_t i = 0; i < 22; ++i) {
    std::complex<double> sum = 0.0;
    for (const auto& a : file.arrivals[i])
      sum += std::polar(a.amplitude, a.phase_deg * M_PI / 180.0 - 2.0 * M_PI * 100.0 * a.delay);
    const std::complex<double> exact =
        mirror(file.receiver_ranges[i % 11], file.receiver_depths[i / 11]);
    EXPECT_LT(std::abs(sum - exact), 1e-6 * std::abs(exact));
  }
  const json one = json::parse(
      asdic(folder, "arrivals mirror.toml --receiver-depth 60m --range 1km --json").out);
  ASSERT_EQ(one["legs"].size(), 1U);
  EXPECT_EQ(one["legs"][0]["arrivals"].size(), 2U);
}

TEST_F(FieldCommand, RaysOfARunAreItsOceans) {
  const auto run = asdic(folder, "rays mirror.toml --elevations 30 --range 1km --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json ray = json::parse(run.out)["rays"][0];
  EXPECT_NEAR(ray["surface_hits"][0].get<double>(), 40.0 / std::tan(M_PI / 6.0), 1e-6);
  ASSERT_EQ(asdic(folder, "rays mirror.toml --count 5 --range 1km -o fan.ray").status, 0);
  EXPECT_EQ(bellhop::read_ray_file(folder / "fan.ray").rays.size(), 5U);
}

// A run of rays names its fan and its box: the command line only changes what it gives.
TEST_F(FieldCommand, ARunOfRaysIsDoneAsItSays) {
  const std::string as_rays = "rays mirror.toml --set run.task=rays --set run.fan.count=7 ";
  ASSERT_EQ(asdic(folder, as_rays + "-o run.ray").status, 0);
  const auto file = bellhop::read_ray_file(folder / "run.ray");
  ASSERT_EQ(file.rays.size(), 7U);
  EXPECT_NEAR(file.rays.front().launch_angle_deg, -60.0, 1e-9);
  EXPECT_NEAR(file.rays.back().launch_angle_deg, 60.0, 1e-9);
  // box_range: 1.01 times the furthest receiver, 1500 m; the ray straight ahead goes that far
  EXPECT_NEAR(file.rays[3].range.back(), 1515.0, 1e-6);

  const json some = json::parse(asdic(folder, as_rays + "--from 0 --count 3 --json").out)["rays"];
  ASSERT_EQ(some.size(), 3U);
  EXPECT_NEAR(some[0]["launch_elevation_deg"].get<double>(), 0.0, 1e-12);
  EXPECT_NEAR(some[2]["launch_elevation_deg"].get<double>(), 60.0, 1e-9);

  ASSERT_EQ(asdic(folder, as_rays + "--set run.source.depth=[40,90] -o two.ray").status, 0);
  EXPECT_EQ(bellhop::read_ray_file(folder / "two.ray").rays.size(), 14U);
  const auto two = asdic(folder, as_rays + "--set run.source.depth=[40,90]");
  EXPECT_EQ(two.status, 2);
  EXPECT_NE(two.err.find("run.source.depth: found 2 depths"), std::string::npos) << two.err;
}

// To each of 22 receivers the direct ray and the one by the surface, as task = "eigenrays" asks.
TEST_F(FieldCommand, ARunOfEigenraysGivesThem) {
  const auto run = asdic(folder, "rays mirror.toml --set run.task=eigenrays --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json rays = json::parse(run.out)["rays"];
  ASSERT_EQ(rays.size(), 44U);
  for (const json& ray : rays) EXPECT_LE(ray["range"].back().get<double>(), 1500.0 + 1e-6);
}

TEST_F(FieldCommand, WrongInputIsToldInOneLine) {
  for (const auto& [words, says] : std::vector<std::pair<std::string, std::string>>{
           {"field none.toml", "none.toml"},
           {"field mirror.toml --set run.source.depth=9000",
            "--set run.source.depth: run.source.depth"},
           {"field mirror.toml --set run.source.depth=-3",
            "--set run.source.depth: run.source.depth"},
           {"field mirror.toml --set run.fan.highest_deg=-60",
            "--set run.fan.highest_deg: run.fan.highest: found -60"},
           {"field mirror.toml --set run.beams.kind=square", "run.beams.kind"},
           {"field mirror.toml -o nowhere/x.h5", "--output"},
           {"field mirror.toml -o mirror.toml", "--output"},
           {"field mirror.toml --set run.task=rays", "run.task: found \"rays\""},
           {"field mirror.toml --set run.task=eigenrays", "run.task: found \"eigenrays\""},
           {"field mirror.toml -o e.ray", "--output: found e.ray"},
           {"arrivals mirror.toml -o e.ray", "--output: found e.ray"},
           {"rays mirror.toml -o e.arr", "--output: found e.arr"},
           {"arrivals mirror.toml --leg target", "platform"}}) {
    const auto run = asdic(folder, words);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_EQ(run.out, "") << words;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace asdic::detail
