#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "study/sampling/index_set.h"
#include "study/sampling/shard.h"
#include "study/summary/until.h"

namespace asdic::detail::study {
namespace {

// The set is what a plain array of flags would be, whatever is added in whatever order.
TEST(IndexSet, IsASetOfIndices) {
  RandomStream random(3, Draw::ambient_noise, 0, 0);
  for (int trial = 0; trial < 200; ++trial) {
    IndexSet set;
    std::vector<bool> flags(64, false);
    for (int i = 0; i < 12; ++i) {
      const auto first = static_cast<std::uint64_t>(60.0 * random.uniform());
      const auto end =
          std::min<std::uint64_t>(64, first + static_cast<std::uint64_t>(6.0 * random.uniform()));
      set.add({first, end});
      for (auto k = first; k < end; ++k) flags[k] = true;
    }
    std::uint64_t count = 0, open = 0;
    const IndexSet missing = set.missing({5, 60});
    const IndexSet within = set.within({5, 60});
    for (std::uint64_t k = 0; k < 64; ++k) {
      EXPECT_EQ(set.contains(k), flags[k]);
      EXPECT_EQ(missing.contains(k), !flags[k] && k >= 5 && k < 60);
      EXPECT_EQ(within.contains(k), flags[k] && k >= 5 && k < 60);
      count += flags[k] ? 1 : 0;
      open += !flags[k] && k >= 5 && k < 60 ? 1 : 0;
    }
    EXPECT_EQ(set.size(), count);
    EXPECT_EQ(missing.size(), open);
    for (std::size_t i = 1; i < set.ranges().size(); ++i)
      EXPECT_GT(set.ranges()[i].first, set.ranges()[i - 1].end) << "ranges lie apart";
  }
}

TEST(IndexSet, SaysWhatItHolds) {
  IndexSet set;
  EXPECT_EQ(index_text(set), "none");
  for (std::uint64_t k = 0; k < 12; k += 2) set.add(k);
  EXPECT_EQ(index_text(set), "0:1, 2:3, 4:5, 6:7 and 2 more");
}

// Parts cover everything once, and no two differ by more than one, at any count.
TEST(Shard, PartsCoverEverythingOnce) {
  for (const std::uint64_t count : {1ULL, 7ULL, 100ULL, 12345ULL, (1ULL << 63) - 25})
    for (const std::uint64_t n : {1ULL, 2ULL, 3ULL, 7ULL, 64ULL}) {
      if (n > count) continue;
      std::uint64_t at = 0, least = count, most = 0;
      for (std::uint64_t i = 1; i <= n; ++i) {
        const IndexRange part = shard(i, n, count);
        EXPECT_EQ(part.first, at);
        at = part.end;
        least = std::min(least, part.size());
        most = std::max(most, part.size());
      }
      EXPECT_EQ(at, count);
      EXPECT_LE(most - least, 1U);
    }
}

std::string fault_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(Shard, SaysWhatIsWrong) {
  const Environment none = [](const std::string&) { return std::nullopt; };
  for (const char* text : {"", "3", "0/3", "4/3", "1/0", "-1/3", "1/3x", "a/b", "1/101"})
    EXPECT_NE(fault_of([&] {
                static_cast<void>(parse_shard(text, 100, none));
              }).find("--shard: found \"" + std::string(text) + "\", expected I/N with 1"),
              std::string::npos)
        << text;
  for (const char* text : {"", "3", "5:5", "7:3", "0:101", ":", "0:1.5"})
    EXPECT_NE(fault_of([&] {
                static_cast<void>(parse_range(text, 100));
              }).find("--realisations: found \"" + std::string(text) + "\", expected FIRST:END"),
              std::string::npos)
        << text;
  EXPECT_NE(fault_of([&] {
              static_cast<void>(parse_shard("slurm", 100, none));
            }).find("found SLURM_ARRAY_TASK_ID not set"),
            std::string::npos);
}

// Tasks of an array may be numbered from 0, from 1 or from anything.
TEST(Shard, SlurmTasksAreCountedFromTheirFirst) {
  const auto array = [](int id, int first, int count) {
    return [=](const std::string& name) -> std::optional<std::string> {
      if (name == "SLURM_ARRAY_TASK_ID") return std::to_string(id);
      if (name == "SLURM_ARRAY_TASK_MIN") return std::to_string(first);
      if (name == "SLURM_ARRAY_TASK_COUNT") return std::to_string(count);
      return std::nullopt;
    };
  };
  EXPECT_EQ(parse_shard("slurm", 100, array(0, 0, 4)), (IndexRange{0, 25}));
  EXPECT_EQ(parse_shard("slurm", 100, array(4, 1, 4)), (IndexRange{75, 100}));
  EXPECT_EQ(parse_shard("slurm", 100, array(11, 10, 4)), (IndexRange{25, 50}));
  EXPECT_NE(fault_of([&] {
              static_cast<void>(parse_shard("slurm", 100, array(9, 1, 3)));
            }).find("expected tasks in a row, as of --array=1-3"),
            std::string::npos);
}

TEST(Until, LooksAtFixedCountsOnly) {
  std::vector<std::uint64_t> looks;
  for (std::uint64_t n = 0; n <= 2000; ++n)
    if (is_look(n)) looks.push_back(n);
  EXPECT_EQ(looks,
            (std::vector<std::uint64_t>{100, 200, 300, 400, 500, 600, 700, 800, 900, 1000, 2000}));
}

TEST(Until, LooksAtWholeBlocksAndReplicates) {
  const auto looks = [](const Clusters& clusters, std::uint64_t end) {
    std::vector<std::uint64_t> all;
    for (std::uint64_t n = 0; n <= end; ++n)
      if (is_look(n, clusters)) all.push_back(n);
    return all;
  };
  EXPECT_EQ(looks({.kind = Clusters::Kind::blocks, .size = 6}, 2000),
            (std::vector<std::uint64_t>{600, 1200, 1800}));
  EXPECT_EQ(looks({.kind = Clusters::Kind::replicates, .size = 16}, 1600),
            (std::vector<std::uint64_t>{128, 192, 256, 384, 512, 768, 1024, 1536}));
}

TEST(Until, RefusesDesignsThatDependOnTheirNumber) {
  for (const Design design : {Design::latin_hypercube, Design::grid}) {
    Study study;
    study.design = design;
    EXPECT_NE(fault_of([&] { check_until(study); }).find("--until: found design = \""),
              std::string::npos);
  }
  Study study;
  for (const Design design : {Design::sobol, Design::saltelli}) {
    study.design = design;
    EXPECT_NO_THROW(check_until(study));
  }
}

}  // namespace
}  // namespace asdic::detail::study
