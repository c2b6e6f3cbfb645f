#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <thread>

#include "core/error.h"
#include "study/run.h"

namespace asdic::study {
namespace {

NextIndex up_to(std::uint64_t count) {
  return [count, at = std::uint64_t{0}]() mutable {
    return at < count ? std::optional(at++) : std::nullopt;
  };
}

// The sink sees 0, 1, 2 … whatever takes how long, and no more rows exist at a time than allowed.
TEST(Run, RowsComeInOrderAndFewAtATime) {
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::atomic<int> alive = 0, most = 0;
    std::uint64_t expected = 0;
    const auto realise = [&](std::uint64_t index) {
      const int now = ++alive;
      int seen = most;
      while (now > seen && !most.compare_exchange_weak(seen, now)) continue;
      if (index % 5 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
      return Row{.index = index};
    };
    const auto sink = [&](Row&& row) {
      EXPECT_EQ(row.index, expected++);
      --alive;
      return true;
    };
    EXPECT_EQ(run(realise, up_to(500), sink, {.in_flight = 6}), 500U);
    EXPECT_LE(most, 6);
  }
}

// Several realisations fail; the first of them is told, after all rows before it.
TEST(Run, TheFirstFaultIsTold) {
  for (const std::size_t threads : {1U, 7U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::uint64_t rows = 0;
    const auto realise = [](std::uint64_t index) {
      if (index == 40) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (index >= 40)
        throw InputError(
            {.where = "realisation " + std::to_string(index), .got = "x", .expected = "y"});
      return Row{.index = index};
    };
    const auto sink = [&](Row&& row) {
      EXPECT_EQ(row.index, rows++);
      return true;
    };
    try {
      run(realise, up_to(500), sink);
      FAIL() << "no fault";
    } catch (const InputError& error) {
      EXPECT_EQ(error.fault().where, "realisation 40");
    }
    EXPECT_EQ(rows, 40U);
  }
}

// A stop lets those in hand end; every row that was begun reaches the sink.
TEST(Run, AStopFinishesWhatIsInHand) {
  std::stop_source stop;
  std::atomic<std::uint64_t> begun = 0;
  std::uint64_t rows = 0;
  const auto realise = [&](std::uint64_t index) {
    ++begun;
    if (index == 20) stop.request_stop();
    return Row{.index = index};
  };
  const auto sink = [&](Row&&) {
    ++rows;
    return true;
  };
  const std::uint64_t made = run(realise, up_to(100000), sink, {.stop = stop.get_token()});
  EXPECT_EQ(made, begun);
  EXPECT_EQ(made, rows);
  EXPECT_GE(made, 21U);
  EXPECT_LT(made, 1000U);
}

TEST(Run, ASinkThatHasEnoughEndsIt) {
  std::uint64_t rows = 0;
  run([](std::uint64_t index) { return Row{.index = index}; }, up_to(100000),
      [&](Row&&) { return ++rows < 50; });
  EXPECT_GE(rows, 50U);
  EXPECT_LT(rows, 1000U);
}

}  // namespace
}  // namespace asdic::study
