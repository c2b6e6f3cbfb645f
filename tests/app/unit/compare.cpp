#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/bellhop/bellhop_files.h"
#include "io/result/result_file.h"
#include "support/program.h"

// asdic compare: what it prints, and how it ends.

namespace asdic::detail {
namespace {

using nlohmann::json;
using support::asdic;

/// A field of one over range, and others that differ from it by a known factor.
class Compare : public ::testing::Test {
 protected:
  void SetUp() override {
    bellhop::write_shade_file(folder / "a.shd", field(std::pow(10.0, 0.5 / 20.0)));  // 0.5 dB more
    bellhop::write_shade_file(folder / "b.shd", field(1.0));
    bellhop::write_arrivals_file(folder / "a.arr", arrivals(2e-6));
    bellhop::write_arrivals_file(folder / "b.arr", arrivals(0.0));
    bellhop::write_ray_file(folder / "a.ray", rays(3.0));
    bellhop::write_ray_file(folder / "b.ray", rays(0.0));
  }

  static bellhop::ShadeFile field(double factor) {
    bellhop::ShadeFile file{.title = "flat",
                            .frequency = 100.0,
                            .source_depths = {50.0},
                            .receiver_depths = {10.0, 20.0},
                            .receiver_ranges = {}};
    for (int i = 1; i <= 20; ++i) file.receiver_ranges.push_back(500.0 * i);
    for (int row = 0; row < 2; ++row)
      for (const double r : file.receiver_ranges)
        file.pressure.emplace_back(static_cast<float>(factor / r), 0.0f);
    return file;
  }

  static inline const std::complex<float> not_a_number{std::nanf(""), std::nanf("")};

  /// asdic writes no field with NaN; other programs do.
  void write_with_holes(const std::string& name, const bellhop::ShadeFile& file) {
    static_cast<void>(folder.write(name, bellhop::shade_file_bytes(file)));
  }

  static bellhop::ArrivalsFile arrivals(double later) {
    bellhop::ArrivalsFile file{.frequency = 1000.0,
                               .source_depths = {50.0},
                               .receiver_depths = {10.0},
                               .receiver_ranges = {1000.0}};
    file.arrivals = {{{.amplitude = 1e-3, .delay = 0.5 + later},
                      {.amplitude = 5e-4, .delay = 0.6 + later, .surface_bounces = 1}}};
    return file;
  }

  static bellhop::RayFile rays(double below) {
    bellhop::RayFile file{
        .title = "straight", .frequency = 100.0, .angles = 1, .bottom_depth = 200.0};
    file.rays = {{.range = {0, 1000, 2000}, .depth = {50 + below, 50 + below, 50 + below}}};
    return file;
  }

  support::TemporaryDirectory folder;
};

TEST_F(Compare, TellsTheDifferenceOfFields) {
  const auto run = asdic(folder, "compare a.shd b.shd --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json all = json::parse(run.out);
  EXPECT_EQ(all["kind"], "field");
  EXPECT_EQ(all["compared"], 40);
  EXPECT_NEAR(all["tl_db"]["median"].get<double>(), 0.5, 1e-5);  // float32
  EXPECT_NEAR(all["tl_db"]["mean"].get<double>(), -0.5, 1e-5);
  EXPECT_NEAR(all["level_db"].get<double>(), 0.5, 1e-5);
  EXPECT_NEAR(all["within_db_pct"]["1"].get<double>(), 100.0, 1e-12);
  const auto table = asdic(folder, "compare a.shd b.shd");
  for (const char* part : {"field: a.shd against b.shd", "40 of 40", "0.5000", "0 % 0.1 dB"})
    EXPECT_NE(table.out.find(part), std::string::npos) << part << " is not in:\n" << table.out;
}

TEST_F(Compare, EndsByTheThresholds) {
  EXPECT_EQ(asdic(folder, "compare a.shd b.shd --max-p95 0.51 --max-median 0.51").status, 0);
  const auto run = asdic(folder, "compare a.shd b.shd --max-p95 0.4");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.out.find("outside   95 % |dTL|: 0.5 dB, expected at most 0.4"), std::string::npos)
      << run.out;
  EXPECT_FALSE(json::parse(
      asdic(folder, "compare a.shd b.shd --json --max-level 0.1").out)["within_thresholds"]);
  EXPECT_EQ(asdic(folder, "compare a.arr b.arr --max-delay-us 2.5 --min-matched 100").status, 0);
  EXPECT_EQ(asdic(folder, "compare a.arr b.arr --max-delay-us 1").status, 1);
  EXPECT_EQ(asdic(folder, "compare a.ray b.ray --max-distance 3.1").status, 0);
  EXPECT_EQ(asdic(folder, "compare a.ray b.ray --max-distance 2.9").status, 1);
  // Where nothing could be compared, nothing passes.
  EXPECT_EQ(asdic(folder, "compare a.shd b.shd --floor 10 --max-p95 5").status, 1);
}

// Half of a field that is not there, or not a number, has no difference that a threshold sees.
TEST_F(Compare, WhatCannotBeComparedPassesNoThreshold) {
  auto holed = field(1.0), silent = field(1.0);
  for (std::size_t i = 0; i < holed.pressure.size(); i += 2) {
    holed.pressure[i] = not_a_number;
    silent.pressure[i] = 0.0F;
  }
  write_with_holes("holed.shd", holed);
  bellhop::write_shade_file(folder / "silent.shd", silent);
  for (const std::string& name : {std::string("holed.shd"), std::string("silent.shd")})
    for (const std::string& order : {name + " b.shd", "b.shd " + name}) {
      EXPECT_EQ(asdic(folder, "compare " + order).status, 0) << order;  // nothing was asked for
      const auto run = asdic(folder, "compare " + order + " --max-p95 0.1");
      EXPECT_EQ(run.status, 1) << order;
      EXPECT_NE(run.out.find("outside   cells compared: 50 %, expected at least 100"),
                std::string::npos)
          << run.out;
      EXPECT_EQ(asdic(folder, "compare " + order + " --max-p95 0.1 --min-compared 50").status, 0);
      EXPECT_EQ(asdic(folder, "compare " + order + " --min-compared 51").status, 1);
    }
  const auto converted = asdic(folder, "convert holed.shd holed.h5");
  EXPECT_EQ(converted.status, 1);
  EXPECT_NE(converted.err.find("not a finite number at 20 of 40 receivers"), std::string::npos)
      << converted.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "holed.h5"));
  // Cells that nobody asks for may be anything: those nearer than --min-range.
  auto near = field(1.0);
  near.pressure[0] = near.pressure[20] = not_a_number;
  write_with_holes("near.shd", near);
  EXPECT_EQ(asdic(folder, "compare near.shd b.shd --max-p95 0.1").status, 1);
  EXPECT_EQ(asdic(folder, "compare near.shd b.shd --max-p95 0.1 --min-range 600m").status, 0);

  // Arrivals with NaN are refused when they are read.
  auto rows = arrivals(0.0);
  rows.arrivals[0].back().phase_deg = std::nan("");
  bellhop::write_arrivals_file(folder / "holed.arr", rows);
  EXPECT_EQ(asdic(folder, "compare holed.arr b.arr --max-delay-us 1").status, 2);
}

TEST_F(Compare, MissedPathsAreNamed) {
  auto fewer = arrivals(0.0);
  fewer.arrivals[0].pop_back();
  bellhop::write_arrivals_file(folder / "fewer.arr", fewer);
  const auto run = asdic(folder, "compare fewer.arr b.arr --min-strong 100");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.out.find("-6.0 dB re the strongest at 1.000 km, 10.0 m: 1 surface and 0 bottom"),
            std::string::npos)
      << run.out;
}

// The same results as HDF5 compare as the files they were made of.
TEST_F(Compare, Hdf5ResultsAreAsGood) {
  for (const char* name : {"a.shd", "a.arr", "a.ray"}) {
    Hdf5File file = Hdf5File::create(folder / "a.h5");
    write_hdf5_result(file, read_result(folder / name));
    file.close();
    const std::string reference = std::string("b") + (name + 1);
    json direct = json::parse(
        asdic(folder, std::string("compare ") + name + " " + reference + " --json").out);
    const auto run = asdic(folder, "compare a.h5 " + reference + " --json");
    ASSERT_EQ(run.status, 0) << run.err;
    json through = json::parse(run.out);
    direct.erase("a");
    through.erase("a");
    EXPECT_EQ(through, direct) << name;
  }
}

TEST_F(Compare, WrongInputIsToldInOneLine) {
  auto other = field(1.0);
  for (double& r : other.receiver_ranges) r += 100.0;
  bellhop::write_shade_file(folder / "other.shd", other);
  static_cast<void>(folder.write("bad.shd", "no field"));
  for (const auto& [words, says] : std::vector<std::pair<std::string, std::string>>{
           {"compare a.shd", "B is required"},
           {"compare a.shd none.shd", "no such file"},
           {"compare a.shd bad.shd", "bad.shd"},
           {"compare a.shd b.arr", "expected two of one kind"},
           {"compare a.shd other.shd", "receiver ranges"},
           {"compare a.shd other.shd --resample", "none at 600 m"},
           {"compare a.shd b.shd --min-matched 99", "--min-matched"},
           {"compare a.arr b.arr --max-distance 1", "--max-distance"},
           {"compare a.ray b.ray --max-p95 1", "--max-p95"},
           {"compare a.shd b.shd --max-p95 -1", "--max-p95"},
           {"compare small.toml b.shd", "small.toml"}}) {
    const auto run = asdic(folder, words);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_EQ(run.out, "") << words;
    EXPECT_TRUE(run.err.starts_with("asdic: ")) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace asdic::detail
