#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "core/error.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/parallel/stop.h"
#include "study/runs/run.h"

namespace asdic::detail::study {
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

// A stop leaves those in hand, whose rows could take minutes; what was made before reaches the
// sink.
TEST(Run, AStopLeavesWhatIsInHand) {
  std::stop_source stop;
  std::atomic<std::uint64_t> begun = 0;
  std::vector<std::uint64_t> rows;
  const auto realise = [&](std::uint64_t index) {
    ++begun;
    if (index == 20) stop.request_stop();
    return Row{.index = index};
  };
  const auto sink = [&](Row&& row) {
    rows.push_back(row.index);
    return true;
  };
  const std::uint64_t made = run(realise, up_to(100000), sink, {.stop = stop.get_token()});
  EXPECT_EQ(made, rows.size());
  EXPECT_LT(made, begun);  // 20 at least is left
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_EQ(std::count(rows.begin(), rows.end(), 20U), 0);
  EXPECT_LT(begun, 1000U);
}

// The loops of a realisation end early, and what comes after them in it is never begun.
TEST(Run, AStopEndsALongRealisationAtOnce) {
  using namespace std::chrono_literals;
  std::stop_source stop;
  std::atomic<bool> first_is_made = false, went_on = false;
  const auto realise = [&](std::uint64_t index) {
    if (index == 0) return Row{.index = index};
    // nested, as a ping's loops are; an hour of it all in all
    in_parallel(60, [&](std::size_t) {
      in_parallel(60000, [&](std::size_t) {
        if (first_is_made) stop.request_stop();
        std::this_thread::sleep_for(1ms);
      });
      went_on = true;
    });
    went_on = true;
    return Row{.index = index};
  };
  std::vector<std::uint64_t> rows;
  const auto begin = std::chrono::steady_clock::now();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
  run(realise, up_to(100),
      [&](Row&& row) {
        rows.push_back(row.index);
        first_is_made = true;
        return true;
      },
      {.stop = stop.get_token()});
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 60s);  // a busy machine's moment
  EXPECT_EQ(rows, std::vector<std::uint64_t>{0});
  EXPECT_FALSE(went_on);
}

// A stop that comes before a realisation's loops begin is not forgotten, within a parallel loop
// either.
TEST(Run, AStopBeforeARealisationEndsIt) {
  std::stop_source stop;
  stop.request_stop();
  std::atomic<int> made = 0, stopped = 0;
  const auto realise = [&](std::size_t) {
    try {
      until_stopped(stop.get_token(), [&] { in_parallel(10, [&](std::size_t) { ++made; }); });
    } catch (const Interrupted&) {
      ++stopped;
    }
  };
  realise(0);
  in_parallel(4, realise);
  EXPECT_EQ(made, 0);
  EXPECT_EQ(stopped, 5);
}

// Outside of a run nothing is called off.
TEST(Run, WithoutAStopNothingIsCalledOff) {
  int made = 0;
  in_parallel(1, [&](std::size_t) { ++made; });
  EXPECT_EQ(made, 1);
}

TEST(Run, ASinkThatHasEnoughEndsIt) {
  std::uint64_t rows = 0;
  run([](std::uint64_t index) { return Row{.index = index}; }, up_to(100000),
      [&](Row&&) { return ++rows < 50; });
  EXPECT_GE(rows, 50U);
  EXPECT_LT(rows, 1000U);
}

}  // namespace
}  // namespace asdic::detail::study
