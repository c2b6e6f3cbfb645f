#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cstring>

#include "study/measures/realisation.h"
#include "study/reader/study_reader.h"

namespace asdic::detail::study {
namespace {

std::vector<Row> rows(const Study& study, std::uint64_t n, bool backwards, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const Realiser realiser(study);
  std::vector<Row> made(n);
  tbb::parallel_for(std::uint64_t{0}, n, [&](std::uint64_t i) {
    const std::uint64_t index = backwards ? n - 1 - i : i;
    made[index] = realiser.realise(index);
  });
  return made;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

// What is kept from one realisation for the next must not change a bit of any row.
TEST(Realisations, AreTheSameBitsInAnyOrderOnAnyNumberOfThreads) {
  for (const char* name : {"known_answer.toml", "detection_range.toml"}) {
    const Study study =
        read_study(std::filesystem::path(ASDIC_SCENARIOS) / "studies" / name,
                   std::vector<std::string>{"study.realisations=64", "measure.time_series=all"});
    const std::uint64_t n = name[0] == 'k' ? 24 : 6;
    const std::vector<Row> one = rows(study, n, false, 1), back = rows(study, n, true, 3);
    for (std::uint64_t i = 0; i < n; ++i) {
      EXPECT_TRUE(same_bits(one[i].values, back[i].values)) << name << ' ' << i;
      EXPECT_EQ(one[i].pressure, back[i].pressure) << name << ' ' << i;
    }
    EXPECT_FALSE(same_bits(one[0].values, one[1].values)) << name;
  }
}

}  // namespace
}  // namespace asdic::detail::study
