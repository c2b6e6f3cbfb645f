#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/huge_pages.h"

// A hint to the system about memory changes nothing of it, wherever it begins and however much it
// is.
namespace asdic::detail {
namespace {

TEST(HugePages, LeaveMemoryAsItIs) {
  std::vector<int> values(5 << 20);  // 20 MB
  std::iota(values.begin(), values.end(), 0);
  const std::vector<int> before = values;
  for (const std::size_t from : {0U, 1U, 1000U})
    for (const std::size_t count : {0U, 1U, 1000U, 1U << 20U, 4U << 20U})
      prefer_huge_pages(values.data() + from, count * sizeof(int));
  prefer_huge_pages(nullptr, 0);
  EXPECT_EQ(values, before);
}

TEST(HugePages, AreForMemoryThatIsStillUnused) {
  std::vector<float> values;
  values.reserve(8 << 20);
  prefer_huge_pages(values.data(), values.capacity() * sizeof(float));
  values.assign(values.capacity(), 0.0F);
  EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float x) { return x == 0.0F; }));
}

}  // namespace
}  // namespace asdic::detail
