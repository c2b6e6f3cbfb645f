#include "core/propagation_memory.h"

#include <gtest/gtest.h>

#include <memory>

// What propagation has found is kept as long as it may be asked for, and no longer.

namespace asdic {
namespace {

ExactKey place(int x) { return ExactKey(Kept::legs, 0).add(x); }

bool keeps(PropagationMemory& memory, int x) { return memory.find<int>(place(x)) != nullptr; }

TEST(PropagationMemory, ForgetsWhatWasUsedLongestAgoBeyondItsBytes) {
  PropagationMemory memory(2500);  // two entries
  for (int x = 0; x < 3; ++x) {
    memory.keep(place(x), std::make_shared<int>(x), 800);  // and some 200 of the entry itself
    EXPECT_TRUE(keeps(memory, 0));
  }
  EXPECT_FALSE(keeps(memory, 1));
  EXPECT_TRUE(keeps(memory, 2));
  EXPECT_LE(memory.bytes(), 2500U);
}

// A platform under way hears each ping from a place of its own: without an end a sequence of
// thousands grew by what every ping had found.
TEST(PropagationMemory, OfASequenceUnderWayStaysWhatItIsAfterItsPings) {
  PropagationMemory memory(1 << 20, 4);
  std::size_t after_few = 0;
  for (int ping = 0; ping < 100; ++ping) {
    memory.next_ping();
    memory.keep(place(ping), std::make_shared<int>(ping), 100);
    if (ping == 4) after_few = memory.bytes();
  }
  EXPECT_EQ(memory.bytes(), after_few);
  EXPECT_TRUE(keeps(memory, 95));
  EXPECT_FALSE(keeps(memory, 94));
}

TEST(PropagationMemory, KeepsWhatIsUsedAgainHoweverManyPingsGoBy) {
  PropagationMemory short_lived(1 << 20, 4), shared(1 << 20);
  for (PropagationMemory* memory : {&short_lived, &shared})
    memory->keep(place(0), std::make_shared<int>(0), 100);
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
}  // namespace asdic
