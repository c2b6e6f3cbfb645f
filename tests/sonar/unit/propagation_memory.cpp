#include "core/propagation_memory.h"

#include <gtest/gtest.h>

#include <memory>

// What propagation has found is kept as long as it may be asked for, and no longer.

namespace asdic::detail {
namespace {

ExactKey place(int x, Kept kind) { return ExactKey(kind, 0).add(x); }

/// \param bytes  of the value; the entry itself takes some 200
void put(PropagationMemory& memory, int x, std::size_t bytes, Kept kind = Kept::slice) {
  const auto found = memory.remember(
      place(x, kind), [&] { return std::make_shared<int>(x); }, [&](int) { return bytes; });
  EXPECT_EQ(*found, x);
}

/// Whether it need not be made again.
bool keeps(PropagationMemory& memory, int x, Kept kind = Kept::slice) {
  struct Made {};
  const auto make = []() -> std::shared_ptr<int> { throw Made(); };
  try {
    return *memory.remember(place(x, kind), make, [](int) { return std::size_t{0}; }) == x;
  } catch (const Made&) {
    return false;
  }
}

TEST(PropagationMemory, ForgetsWhatWasUsedLongestAgoBeyondItsBytes) {
  PropagationMemory memory(2500);  // two entries
  for (int x = 0; x < 3; ++x) {
    put(memory, x, 800);
    EXPECT_TRUE(keeps(memory, 0));
  }
  EXPECT_FALSE(keeps(memory, 1));
  EXPECT_TRUE(keeps(memory, 2));
  EXPECT_LE(memory.bytes(), 2500U);
}

// Ends that move leave thousands of legs behind, which take a third at most.
TEST(PropagationMemory, LegsDoNotPushOutTheRest) {
  PropagationMemory memory(100'000);
  put(memory, 0, 60'000);
  for (int x = 0; x < 200; ++x) put(memory, x, 800, Kept::followed_legs);
  EXPECT_TRUE(keeps(memory, 0));
  EXPECT_TRUE(keeps(memory, 199, Kept::followed_legs));
  EXPECT_FALSE(keeps(memory, 100, Kept::followed_legs));
  EXPECT_LE(memory.bytes(), 100'000U);
}

// A platform under way receives each ping from a place of its own: without an end a sequence of
// thousands grew by what every ping had found.
TEST(PropagationMemory, OfASequenceUnderWayStaysWhatItIsAfterItsPings) {
  PropagationMemory memory(1 << 20, 4);
  std::size_t after_few = 0;
  for (int ping = 0; ping < 100; ++ping) {
    memory.next_ping();
    put(memory, ping, 100);
    if (ping == 4) after_few = memory.bytes();
  }
  EXPECT_EQ(memory.bytes(), after_few);
  EXPECT_TRUE(keeps(memory, 95));
  EXPECT_FALSE(keeps(memory, 94));
}

TEST(PropagationMemory, KeepsWhatIsUsedAgainHoweverManyPingsGoBy) {
  PropagationMemory short_lived(1 << 20, 4), shared(1 << 20);
  for (PropagationMemory* memory : {&short_lived, &shared}) put(*memory, 0, 100);
  for (int ping = 0; ping < 100; ++ping) {
    short_lived.next_ping();
    shared.next_ping();
    if (ping % 4 == 0) {
      EXPECT_TRUE(keeps(short_lived, 0));
    }
  }
  EXPECT_TRUE(keeps(shared, 0));
}

}  // namespace
}  // namespace asdic::detail
