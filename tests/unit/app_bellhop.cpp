#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/file_bytes.h"
#include "support/program.h"

// `asdic bellhop` and `asdic convert`: what they write, what they say, and what they leave behind.

namespace asdic {
namespace {

using support::asdic;

const std::filesystem::path data = std::filesystem::path(ASDIC_TEST_DATA) / "bellhop";

class BellhopCommand : public ::testing::Test {
 protected:
  std::string case_of(const std::string& name) { return (data / name / "case").string(); }
  std::string text(const std::string& name) { return bellhop::read_bytes(folder / name, ""); }
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
  EXPECT_FALSE(exists("out.ray.part"));
  EXPECT_FALSE(exists("out.shd"));
}

// The literal run of a case with shallow water and few beams: BELLHOP's own file, number for
// number.
TEST_F(BellhopCommand, LikeBellhopWritesBellhopsArrivals) {
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

TEST_F(BellhopCommand, CasesBecomeScenariosAndCasesAgain) {
  const auto there = asdic(folder, "convert " + case_of("seamount-curved") + ".env a.toml");
  ASSERT_EQ(there.status, 0) << there.err;
  const auto back = asdic(folder, "convert a.toml b.env");
  ASSERT_EQ(back.status, 0) << back.err;
  EXPECT_TRUE(exists("b.bty"));
  ASSERT_EQ(asdic(folder, "convert b.env c.toml").status, 0);
  EXPECT_EQ(text("a.toml"), text("c.toml"));
}

TEST_F(BellhopCommand, ResultsBecomeHdf5AndTheSameBytesAgain) {
  for (const char* name :
       {"pekeris-coherent/case.shd", "deep-source-arrivals/case.arr", "rays-upslope/case.ray"}) {
    const std::string file = (data / name).string(), extension = file.substr(file.size() - 4);
    ASSERT_EQ(asdic(folder, "convert " + file + " x.h5").status, 0) << name;
    ASSERT_EQ(asdic(folder, "convert x.h5 x" + extension).status, 0) << name;
    EXPECT_TRUE(text("x" + extension) == bellhop::read_bytes(file, "")) << name;
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
}  // namespace asdic
