// Processes that share a folder and make one study. Truth: the file of one process.
#include "study/crew/crew_run.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include "core/error.h"
#include "study/crew/block_board.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

using namespace std::chrono_literals;

class Board : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<BlockBoard> join(IndexRange range = {0, 10},
                                                 BlockBoard::Seconds silence = 100s) const {
    return std::make_unique<BlockBoard>(folder_, "identity", range, silence);
  }
  support::TemporaryDirectory home_;
  std::filesystem::path folder_ = home_.path() / "study.h5.crew";
};

TEST_F(Board, EachBlockIsOnesAlone) {
  const auto a = join(), b = join();
  EXPECT_NE(a->worker(), b->worker());
  std::set<std::uint64_t> taken;
  for (int k = 0; k < 5; ++k)
    for (const auto& one : {a.get(), b.get()}) {
      const auto block = one->take();
      ASSERT_TRUE(block);
      EXPECT_TRUE(taken.insert(block->number).second);
      one->done(*block);
    }
  EXPECT_FALSE(a->take());
  EXPECT_TRUE(a->all_done());
  EXPECT_EQ(a->rows_done(), 10U);
}

TEST_F(Board, WhatIsGivenBackIsTakenAgain) {
  const auto a = join({0, 1}), b = join({0, 1});
  const auto block = a->take();
  ASSERT_TRUE(block);
  EXPECT_FALSE(b->take());
  a->give_back(*block);
  const auto again = b->take();
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->before);
}

// Who is silent is gone, and only then; what was its comes with its number.
TEST_F(Board, OneThatIsGoneLosesItsBlock) {
  const auto lost = join({0, 1}, 100s);
  ASSERT_TRUE(lost->take());
  const auto b = join({0, 1}, 200ms);
  EXPECT_FALSE(b->take());  // seen for the first time
  for (int k = 0; k < 6; ++k) {
    std::this_thread::sleep_for(50ms);
    lost->live();
    EXPECT_FALSE(b->take());
  }
  std::this_thread::sleep_for(300ms);
  const auto block = b->take();
  ASSERT_TRUE(block);
  EXPECT_EQ(block->before, lost->worker());
  b->done(*block);
  EXPECT_TRUE(b->all_done());
}

// Many at once, some of which go in the middle of a block: every block is done.
TEST_F(Board, ManyComeAndGo) {
  constexpr std::uint64_t rows = 9000;
  std::atomic<std::uint64_t> made = 0;
  std::vector<std::jthread> crew;
  for (int k = 0; k < 8; ++k)
    crew.emplace_back([&, k] {
      const auto board = join({0, rows}, 100s);
      for (int blocks = 0;; ++blocks) {
        const auto block = board->take();
        if (!block && board->all_done()) return;
        if (!block) std::this_thread::sleep_for(10ms);
        if (!block) continue;
        if (k < 4 && blocks == 20) return;  // what it has is free as it leaves
        made += block->range.size();
        board->done(*block);
      }
    });
  crew.clear();
  EXPECT_EQ(made, rows);
  const auto last = join({0, rows});
  EXPECT_TRUE(last->all_done());
  EXPECT_EQ(last->rows_done(), rows);
  EXPECT_TRUE(last->assembles());
  last->remove();
  EXPECT_TRUE(last->is_over());
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(Board, OneMakesTheFile) {
  const auto a = join(), b = join();
  EXPECT_TRUE(b->assembles());
  EXPECT_FALSE(a->assembles());
}

TEST_F(Board, AnotherStudyIsRefused) {
  const auto a = join();
  EXPECT_THROW(BlockBoard(folder_, "another", {0, 10}, 1s), InputError);
  EXPECT_THROW(BlockBoard(folder_, "identity", {0, 11}, 1s), InputError);
}

TEST_F(Board, AFolderHoldsAnyStudysBlocks) {
  EXPECT_EQ(BlockBoard::block_size(1), 1U);
  EXPECT_EQ(BlockBoard::block_size(4096), 1U);
  EXPECT_EQ(BlockBoard::block_size(4097), 2U);
  EXPECT_LE(10'000'000 / BlockBoard::block_size(10'000'000), 65536U);
  EXPECT_GT(10'000'000 / BlockBoard::block_size(10'000'000), 60000U) << "some for 10⁴ workers each";
  EXPECT_EQ(1'000'000 / BlockBoard::block_size(1'000'000), 15625U);
}

}  // namespace
}  // namespace asdic::detail::study
