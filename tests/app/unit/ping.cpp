#include <gtest/gtest.h>

#include "io/ping/ping_file.h"
#include "support/left_of.h"
#include "support/program.h"

// `asdic ping` as a user meets it: what is written, what is said, how it ends.

namespace asdic::detail {
namespace {

using support::asdic;

class PingCommand : public ::testing::Test {
 protected:
  void SetUp() override { static_cast<void>(folder.write("small.toml", support::small_scenario)); }
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(folder / name);
  }
  support::TemporaryDirectory folder;
};

TEST_F(PingCommand, WritesACompleteFileUnderTheScenariosName) {
  // Its numbers of bounces are too few for its water, which is warned of.
  const auto run = asdic(folder,
                         "ping small.toml --set propagation.max_surface_bounces=auto "
                         "--set propagation.max_bottom_bounces=auto");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");                              // no progress on a pipe
  EXPECT_EQ(run.out.find('\x1b'), std::string::npos);  // no colours either
  EXPECT_NE(run.out.find("rock"), std::string::npos);
  EXPECT_EQ(support::left_of(folder / "small.h5"), "");
  const PingFile file(folder / "small.h5");
  EXPECT_TRUE(file.complete());
  EXPECT_EQ(file.pings(), 2U);
  EXPECT_EQ(file.channels(), 2U);
  EXPECT_EQ(file.samples(), 20000U);
  EXPECT_EQ(file.scenario_text(), support::small_scenario);
}

TEST_F(PingCommand, TellsWhoMadeTheFile) {
  ASSERT_EQ(asdic(folder, "ping small.toml --threads 2 -q").status, 0);
  const PingFile file(folder / "small.h5");
  for (const char* key : {"program_version", "build"})
    EXPECT_NE(file.file().attribute_text("", key), "") << key;
  for (const char* key : {"host", "started", "cpu", "library_versions"})
    EXPECT_NE(file.file().attribute_text("run", key), "") << key;
  EXPECT_NE(file.file().attribute_text("run", "library_versions").find("FFTW 3."),
            std::string::npos);
  EXPECT_EQ(file.file().attribute_number("run", "threads"), 2.0);
}

TEST_F(PingCommand, OverridesAreInTheFile) {
  ASSERT_EQ(asdic(folder, "ping small.toml -o o.h5 --pings 3 --seed 7 --set array.phones=4").status,
            0);
  const PingFile file(folder / "o.h5");
  EXPECT_EQ(file.pings(), 3U);
  EXPECT_EQ(file.channels(), 4U);
  EXPECT_EQ(file.file().attribute_number("", "seed"), 7.0);
  const auto overrides = file.file().attribute_texts("", "overrides");
  EXPECT_EQ(overrides, (std::vector<std::string>{"array.phones=4", "pings.count=3", "seed=7"}));
}

// A fan of 41 rays, and the paths to the target: with at most one bounce at the surface and one at
// the bottom there are the direct one, s, b, sb and bs.
TEST_F(PingCommand, DrawsTheFanAndTheEigenrays) {
  ASSERT_EQ(asdic(folder, "ping small.toml -q").status, 0);
  const PingFile file(folder / "small.h5");
  const auto kinds = file.file().read<std::int32_t>("rays/kind");
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), 0), 41);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), 1), 5);
}

TEST_F(PingCommand, QuietMeansQuiet) {
  const auto run = asdic(folder, "ping small.toml --quiet");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST_F(PingCommand, ThreadsDoNotChangeASample) {
  ASSERT_EQ(asdic(folder, "ping small.toml -q --pings 4 --threads 1 -o one.h5").status, 0);
  ASSERT_EQ(asdic(folder, "ping small.toml -q --pings 4 --threads 3 -o three.h5").status, 0);
  const PingFile one(folder / "one.h5"), three(folder / "three.h5");
  for (std::size_t ping = 0; ping < 4; ++ping)
    for (std::size_t channel = 0; channel < 2; ++channel)
      EXPECT_EQ(one.pressure(ping, channel), three.pressure(ping, channel));
}

// The direct echo of the small sea: slant range √(3000² + 300²) m, out and back at 1500 m/s.
TEST_F(PingCommand, SaysWhenTheEchoComes) {
  const auto run = asdic(folder, "ping small.toml --pings 1");
  EXPECT_NE(run.out.find("4.020"), std::string::npos) << run.out;
}

TEST_F(PingCommand, AFileThatIsThereIsReplacedOnlyByAWholeOne) {
  static_cast<void>(folder.write("small.h5", "precious"));
  EXPECT_EQ(asdic(folder, "ping small.toml -q").status, 2);  // not asdic's
  EXPECT_EQ(support::content(folder / "small.h5"), "precious");
  ASSERT_EQ(asdic(folder, "ping small.toml -q --force").status, 0);
  const std::string before = support::content(folder / "small.h5");
  EXPECT_EQ(asdic(folder, "ping small.toml", "ulimit -f 20;").status, 1);
  EXPECT_EQ(support::content(folder / "small.h5"), before);
  ASSERT_EQ(asdic(folder, "ping small.toml -q").status, 0);
  EXPECT_TRUE(PingFile(folder / "small.h5").complete());
}

// A limit on the size of files stands for a full disk: the same failed write.
TEST_F(PingCommand, AFullDiskIsOneMessageAndNoFile) {
  const auto run = asdic(folder, "ping small.toml --pings 50 -q", "ulimit -f 1000;");
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(run.err.starts_with("asdic: ")) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_FALSE(exists("small.h5"));
}

TEST_F(PingCommand, AFullDiskOnTheVeryFirstWriteLeavesNothing) {
  const auto run = asdic(folder, "ping small.toml -q", "ulimit -f 1;");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_FALSE(exists("small.h5"));
  EXPECT_EQ(support::left_of(folder / "small.h5"), "");
}

}  // namespace
}  // namespace asdic::detail
