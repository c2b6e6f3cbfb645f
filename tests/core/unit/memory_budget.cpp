#include "core/memory_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using testing::HasSubstr;

/// A machine's /proc and /sys, as far as control groups go.
class Machine {
 public:
  void file(const std::string& path, const std::string& content) const {
    std::filesystem::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << content << '\n';
  }
  [[nodiscard]] MemoryLimit limit() const { return memory_limit(folder_.path()); }

 private:
  support::TemporaryDirectory folder_;
};

TEST(MemoryLimit, OfTheGroupAboveCounts) {
  const Machine machine;
  machine.file("proc/self/cgroup", "0::/job/step");
  machine.file("sys/fs/cgroup/job/memory.max", "64000000");
  machine.file("sys/fs/cgroup/job/step/memory.max", "max");
  EXPECT_EQ(machine.limit().bytes, 64e6);
  EXPECT_EQ(machine.limit().source, "the control group's memory");
  machine.file("sys/fs/cgroup/job/step/memory.high", "32000000");
  EXPECT_EQ(machine.limit().bytes, 32e6);
}

TEST(MemoryLimit, OfVersionOneAndOfAContainerThatSeesItsGroupAsTheRoot) {
  const Machine machine;
  machine.file("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/docker/1f\n0::/docker/1f");
  EXPECT_EQ(machine.limit().source, "the machine's memory");
  machine.file("sys/fs/cgroup/memory/memory.limit_in_bytes", "128000000");
  EXPECT_EQ(machine.limit().bytes, 128e6);
}

TEST(MemoryLimit, NoGroupIsNoLimit) {
  const Machine machine;
  EXPECT_EQ(machine.limit().source, "the machine's memory");
  EXPECT_GT(machine.limit().bytes, 1e8);
}

TEST(MemoryBudget, DefaultIsHalfAndRanksShareIt) {
  EXPECT_DOUBLE_EQ(MemoryBudget().bytes(), 0.5 * memory_limit().bytes);
  EXPECT_DOUBLE_EQ(MemoryBudget(4).bytes(), memory_limit().bytes / 8.0);
  EXPECT_THAT(MemoryBudget(4).text(), HasSubstr("one of 8 parts of"));
  EXPECT_EQ(MemoryBudget::of(5e8).bytes(), 5e8);
  EXPECT_EQ(MemoryBudget::of(5e8).share(1e8, "a share").bytes(), 1e8);
}

TEST(MemoryBudget, TheLargestNeedIsNamed) {
  MemoryBudget budget = MemoryBudget::of(1e9);
  budget.take({.where = "pings.recording_duration",
               .what = "8 samples",
               .bytes = 3e8,
               .remedy = "a shorter record"});
  EXPECT_EQ(budget.left(), 7e8);
  try {
    budget.take({.where = "reverberation.ground_spacing",
                 .what = "12 pairs",
                 .bytes = 8e8,
                 .remedy = "a larger spacing"});
    FAIL() << "it is too much";
  } catch (const MemoryError& error) {
    EXPECT_EQ(error.needed(), 1.1e9);
    EXPECT_STREQ(error.what(),
                 "reverberation.ground_spacing: found 12 pairs, which take 800.0 MB of memory "
                 "(1.1 GB in all), expected at most 1.0 GB, as run.memory says: a larger spacing, "
                 "or a larger run.memory");
  }
}

TEST(MemoryBudget, NoKeyIsNamedWhereThereIsNone) {
  MemoryBudget budget = MemoryBudget::without_key();
  try {
    budget.take({.where = "FILE", .what = "samples", .bytes = 1e18, .remedy = "a shorter pulse"});
    FAIL() << "it is too much";
  } catch (const MemoryError& error) {
    EXPECT_THAT(error.what(), testing::EndsWith(": a shorter pulse"));
  }
}

TEST(BytesText, PowersOfAThousand) {
  EXPECT_EQ(bytes_text(12.0), "12 bytes");
  EXPECT_EQ(bytes_text(999.6), "1.0 kB");
  EXPECT_EQ(bytes_text(61.5e6), "61.5 MB");
  EXPECT_EQ(bytes_text(2.5e18), "2500.0 PB");
}

}  // namespace
}  // namespace asdic::detail
