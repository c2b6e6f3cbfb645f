#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "io/bellhop/bellhop_files.h"
#include "io/files/input_file.h"
#include "support/left_of.h"
#include "support/program.h"

// `asdic bellhop` and `asdic convert`: what they write, what they say, and what they leave behind.

namespace asdic::detail {
namespace {

using support::asdic;

const std::filesystem::path data = std::filesystem::path(ASDIC_TEST_DATA) / "bellhop";

class BellhopCommand : public ::testing::Test {
 protected:
  std::string case_of(const std::string& name) { return (data / name / "case").string(); }
  std::string text(const std::string& name) { return read_input(folder / name, ""); }
  bool exists(const std::string& name) { return std::filesystem::exists(folder / name); }

  support::TemporaryDirectory folder;
};

TEST_F(BellhopCommand, WritesRaysAndAReport) {
  const auto run = asdic(folder, "bellhop " + case_of("rays-upslope") + " -o out");
  ASSERT_EQ(run.status, 0) << run.err;
  const bellhop::RayFile rays = bellhop::read_ray_file(folder / "out.ray");
  EXPECT_EQ(rays.rays.size(), 21U);
  EXPECT_EQ(rays.rays.front().launch_angle_deg, -40.0);
  EXPECT_EQ(rays.bottom_depth, 1000.0);
  EXPECT_EQ(run.out, text("out.prt"));
  for (const char* part : {"ray paths over a slope", "monotone cubic", "5 nodes from 0 to 30 km",
                           "step 0: asdic chooses its own", "out.ray", "parse", "search", "write"})
    EXPECT_NE(run.out.find(part), std::string::npos) << part << " is not in:\n" << run.out;
  EXPECT_EQ(support::left_of(folder / "out.ray"), "");
  EXPECT_FALSE(exists("out.shd"));
}

// The literal run of a case with shallow water and few beams: BELLHOP's own file, number for
// number.
TEST_F(BellhopCommand, BellhopEmulationWritesBellhopsArrivals) {
  const auto run =
      asdic(folder, "bellhop " + case_of("elastic-arrivals") + ".env --like-bellhop -q -o out");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const auto ours = bellhop::read_arrivals_file(folder / "out.arr");
  const auto theirs = bellhop::read_arrivals_file(data / "elastic-arrivals/case.arr");
  EXPECT_EQ(ours.receiver_ranges, theirs.receiver_ranges);
  ASSERT_EQ(ours.arrivals.size(), theirs.arrivals.size());
  for (std::size_t i = 0; i < ours.arrivals.size(); ++i)
    EXPECT_EQ(ours.arrivals[i].size(), theirs.arrivals[i].size()) << i;
}

TEST_F(BellhopCommand, ARunThatFailsLeavesAReport) {
  static_cast<void>(folder.write("bad.env", "'bad'\n-1\n"));
  const auto run = asdic(folder, "bellhop bad");
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.err, "asdic: bad.env:2: frequency: found -1 Hz, expected a frequency above 0 Hz\n");
  EXPECT_NE(text("bad.prt").find("FATAL ERROR: bad.env:2: frequency"), std::string::npos);
  EXPECT_FALSE(exists("bad.shd"));
}

// What only the run finds is told of the line it comes from.
TEST_F(BellhopCommand, AFanOfOneAngleIsToldOfItsLine) {
  static_cast<void>(folder.write("one.env", R"('one beam'
250.0
1
'CVW'
2 0.0 200.0
0.0 1500.0 /
200.0 1500.0 /
'R' 0.0
1
45 /
2
50 150 /
2
0.5 1 /
'C'
1
10 /
0.0 250.0 1.2
)"));
  const auto run = asdic(folder, "bellhop one");
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.err.find("asdic: one.env:17: launch angles: found one elevation"), 0U) << run.err;
}

TEST_F(BellhopCommand, CasesBecomeScenariosAndCasesAgain) {
  const auto there = asdic(folder, "convert " + case_of("seamount-curved") + ".env a.toml");
  ASSERT_EQ(there.status, 0) << there.err;
  const auto back = asdic(folder, "convert a.toml b.env");
  ASSERT_EQ(back.status, 0) << back.err;
  EXPECT_TRUE(exists("b.bty"));
  ASSERT_EQ(asdic(folder, "convert b.env c.toml").status, 0);
  EXPECT_EQ(text("a.toml"), text("c.toml"));
}

// The scenario of a ray run gives the rays of the case: its own 21, not a fan of the command's.
TEST_F(BellhopCommand, AConvertedRunOfRaysGivesTheCasesRays) {
  ASSERT_EQ(asdic(folder, "bellhop " + case_of("rays-upslope") + " -q -o a").status, 0);
  ASSERT_EQ(asdic(folder, "convert " + case_of("rays-upslope") + ".env s.toml").status, 0);
  const auto run = asdic(folder, "rays s.toml -o b.ray");
  ASSERT_EQ(run.status, 0) << run.err;
  const bellhop::RayFile a = bellhop::read_ray_file(folder / "a.ray"),
                         b = bellhop::read_ray_file(folder / "b.ray");
  ASSERT_EQ(a.rays.size(), b.rays.size());
  for (std::size_t i = 0; i < a.rays.size(); ++i) {
    EXPECT_NEAR(a.rays[i].launch_angle_deg, b.rays[i].launch_angle_deg, 1e-9);
    ASSERT_EQ(a.rays[i].range.size(), b.rays[i].range.size()) << i;
    // angles pass through degrees in the scenario: a last bit of 40 degrees is 4e-10 m at 25 km
    EXPECT_NEAR(a.rays[i].depth.back(), b.rays[i].depth.back(), 1e-3) << i;
  }
}

// Ice over water whose rows give only depth and speed: the water has the loss of the ice.
TEST_F(BellhopCommand, ALeakOfIceIntoWaterIsTold) {
  static_cast<void>(folder.write("ice.env", R"('ice'
250.0
1
'CAW'
0 3300 1700 0.9 0.3 1
2 0.0 200.0
0.0 1500.0 /
200.0 1500.0 /
'A' 0.0
200.0 1600.0 0.0 1.8 0.5 /
1
45 /
2
50 150 /
2
0.5 1 /
'C'
0
-30.0 30.0 /
0.0 250.0 1.2
)"));
  const std::string leak =
      "ice.env:7: profile row 1: density 0.9 g/cm^3, attenuation 0.3: left out";
  const auto run = asdic(folder, "bellhop ice -q");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err.find("asdic: note: " + leak), 0U) << run.err;
  EXPECT_NE(text("ice.prt").find("note       " + leak), std::string::npos);
  // 0.3 dB in each 6 m
  EXPECT_NE(text("ice.prt").find("\nabsorption 50 dB/km, 50 of it by the rows of the profile\n"),
            std::string::npos);
  const auto explained = asdic(folder, "explain ice -q");
  ASSERT_EQ(explained.status, 0) << explained.err;
  const std::size_t said = explained.out.find("* look at the input first: " + leak);
  ASSERT_NE(said, std::string::npos) << explained.out;
  EXPECT_LT(said, explained.out.find("* trust"));
}

TEST_F(BellhopCommand, ResultsBecomeHdf5AndTheSameBytesAgain) {
  for (const char* name :
       {"pekeris-coherent/case.shd", "deep-source-arrivals/case.arr", "rays-upslope/case.ray"}) {
    const std::string file = (data / name).string(), extension = file.substr(file.size() - 4);
    ASSERT_EQ(asdic(folder, "convert " + file + " x.h5").status, 0) << name;
    ASSERT_EQ(asdic(folder, "convert x.h5 x" + extension).status, 0) << name;
    EXPECT_TRUE(text("x" + extension) == read_input(file, "")) << name;
  }
}

// The way a file was written comes along, unless another is asked for.
TEST_F(BellhopCommand, TheOtherDialectComesBackToo) {
  const std::string file = (data / "deep-source-arrivals/case.arr").string();
  ASSERT_EQ(asdic(folder, "convert " + file + " wide.arr --wide --binary").status, 0);
  ASSERT_EQ(asdic(folder, "convert wide.arr x.h5").status, 0);
  ASSERT_EQ(asdic(folder, "convert x.h5 same.arr").status, 0);
  EXPECT_TRUE(text("same.arr") == text("wide.arr"));
  ASSERT_EQ(asdic(folder, "convert x.h5 text.arr --ascii --fortran").status, 0);
  EXPECT_FALSE(text("text.arr") == text("wide.arr"));
  EXPECT_EQ(asdic(folder, "convert x.h5 y.arr --ascii --binary").status, 2);
}

TEST_F(BellhopCommand, ConvertSaysWhatGoesTogether) {
  const auto run = asdic(folder, "convert " + (data / "rays-upslope/case.ray").string() + " x.shd");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("expected rays into .h5 or into their own kind of file"),
            std::string::npos)
      << run.err;
  EXPECT_FALSE(exists("x.shd"));
}

}  // namespace
}  // namespace asdic::detail
