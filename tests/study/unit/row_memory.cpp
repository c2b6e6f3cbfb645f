#include "study/measures/row_memory.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "core/memory_budget.h"

namespace asdic::detail::study {
namespace {

/// A row that needs so much, by what a simulator would ask of its share.
double made_with(RowMemory& memory, double need) {
  double got = 0.0;
  memory.within([&](double bytes) {
    got = bytes;
    if (need > bytes) throw MemoryError({.where = "row", .got = "", .expected = ""}, need);
  });
  return got;
}

TEST(RowMemory, ALargeRowGetsWhatItAsksFor) {
  RowMemory memory(1000.0, 4);
  EXPECT_EQ(made_with(memory, 200.0), 250.0);
  EXPECT_EQ(made_with(memory, 600.0), 600.0);
  EXPECT_EQ(made_with(memory, 1000.0), 1000.0);
  EXPECT_THROW(made_with(memory, 1001.0), MemoryError);
}

// Whatever rows ask for, those in hand never have more than all, and each that fits is made.
TEST(RowMemory, RowsAtATimeKeepWithinAll) {
  RowMemory memory(1000.0, 8);
  std::atomic<int> held = 0, most = 0, made = 0;
  tbb::parallel_for(0, 400, [&](int row) {
    const double need = 100.0 + (row * 37) % 900;
    memory.within([&](double bytes) {
      const int now = held += static_cast<int>(bytes);
      for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
      }
      held -= static_cast<int>(bytes);
      if (need > bytes) throw MemoryError({.where = "row", .got = "", .expected = ""}, need);
      ++made;
    });
  });
  EXPECT_EQ(made, 400);
  EXPECT_LE(most, 1000);
}

}  // namespace
}  // namespace asdic::detail::study
