#include "serve/turns.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

namespace asdic::detail::serve {
namespace {

/// Waits for its turn in a thread of its own, and writes its name when it has it.
class Waiting {
 public:
  Waiting(Turns& turns, const ComputedTime& computed, double now, std::string& order, char name)
      : thread_([&turns, &order, computed, now, name, off = off_.get_token()] {
          if (!turns.take(computed, now, off)) return;
          order += name;
          turns.give_back();
        }) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // so that it has come
  }
  void call_off() { off_.request_stop(); }

 private:
  std::stop_source off_;
  std::jthread thread_;
};

TEST(Turns, AreTakenInTheOrderInWhichTheyCame) {
  Turns turns;
  std::string order;
  const ComputedTime none;
  ASSERT_TRUE(turns.take(none, 0.0, {}));
  {
    Waiting a(turns, none, 1.0, order, 'a'), b(turns, none, 2.0, order, 'b');
    Waiting gone(turns, none, 2.5, order, 'x'), c(turns, none, 3.0, order, 'c');
    gone.call_off();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    turns.give_back();
  }
  EXPECT_EQ(order, "abc");
}

// 30 s of computing count as 30 s later: behind those who came 20 s after, before those who came
// 40 s after. It fades with e^{-t/60 s}.
TEST(Turns, WhoHasComputedComesLater) {
  ComputedTime much;
  much.add(30.0, 100.0);
  EXPECT_DOUBLE_EQ(much.lately(100.0), 30.0);
  EXPECT_DOUBLE_EQ(much.lately(160.0), 30.0 / std::exp(1.0));
  much.add(1.0, 160.0);
  EXPECT_DOUBLE_EQ(much.lately(160.0), 30.0 / std::exp(1.0) + 1.0);
  EXPECT_DOUBLE_EQ(much.in_all(), 31.0);

  Turns turns;
  std::string order;
  ComputedTime heavy;
  heavy.add(30.0, 1000.0);
  ASSERT_TRUE(turns.take({}, 1000.0, {}));
  {
    Waiting first(turns, heavy, 1000.0, order, 'h'), second(turns, {}, 1020.0, order, 'b');
    Waiting third(turns, {}, 1040.0, order, 'c');
    turns.give_back();
  }
  EXPECT_EQ(order, "bhc");
}

TEST(Turns, ARequestBeforeItsTurnIsFinal) {
  Turns turns;
  ASSERT_TRUE(turns.take({}, 0.0, {}));
  std::stop_source off;
  off.request_stop();
  EXPECT_FALSE(turns.take({}, 0.0, off.get_token()));
  turns.give_back();
  EXPECT_TRUE(turns.take({}, 0.0, {}));
}

}  // namespace
}  // namespace asdic::detail::serve
