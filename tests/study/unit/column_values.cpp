#include "study/summary/column_values.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <numeric>
#include <string>

// Truth: a vector of the same values.
namespace asdic::detail::study {
namespace {

double value(std::size_t i) { return static_cast<double>((i * 2654435761U) % 1000003U); }

TEST(ColumnValues, IsTheVectorThatItStandsFor) {
  ColumnValues column;
  std::vector<double> truth;
  for (std::size_t i = 0; i < 3 * ColumnValues::most_in_memory + 17; ++i) {
    column.push_back(value(i));
    truth.push_back(value(i));
    if (i + 1 == ColumnValues::most_in_memory) {
      EXPECT_FALSE(column.in_file());
    }
  }
  EXPECT_TRUE(column.in_file());
  ASSERT_EQ(column.size(), truth.size());
  EXPECT_TRUE(std::equal(column.begin(), column.end(), truth.begin()));
  column.rest();
  EXPECT_TRUE(std::equal(column.begin(), column.end(), truth.begin())) << "what rests comes back";
  column[5] = -1.0;
  column.rest();
  EXPECT_EQ(column[5], -1.0) << "what was written and rests is not lost";
  ColumnValues copy = column;
  column[5] = 7.0;
  EXPECT_EQ(copy[5], -1.0) << "a copy is of its own";
  const ColumnValues moved = std::move(column);
  EXPECT_EQ(moved[5], 7.0);
  copy.pop_back();
  copy.push_back(3.0);
  EXPECT_EQ(copy.at(truth.size() - 1), 3.0);
  EXPECT_THROW(static_cast<void>(copy.at(truth.size())), std::out_of_range);
}

TEST(ColumnValues, StaysInMemoryWhereThereIsNoRoom) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit none = before;
  none.rlim_cur = 0;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &none), 0);
  ColumnValues column;
  for (std::size_t i = 0; i < ColumnValues::most_in_memory + 9; ++i) column.push_back(value(i));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(column.in_file());
  for (std::size_t i = 0; i < column.size(); i += 1000) ASSERT_EQ(column[i], value(i));
  column.clear();
  EXPECT_TRUE(column.empty());
  column.push_back(4.0);
  EXPECT_EQ(column[0], 4.0);
}

double resident() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return 1024.0 * std::stod(line.substr(6));
  return 0.0;
}

/// Twenty columns of 2 million values are 320 MB; in memory there is a few MB of them.
TEST(ColumnValues, TableLeavesMemory) {
  const double before = resident();
  std::vector<ColumnValues> table(20);
  for (std::size_t i = 0; i < 2000000; ++i)
    for (ColumnValues& column : table) column.push_back(value(i));
  EXPECT_LT(resident() - before, 120e6);
  for (const ColumnValues& column : table) {
    static_cast<void>(std::accumulate(column.begin(), column.end(), 0.0));
    column.rest();
  }
  EXPECT_LT(resident() - before, 120e6) << "a column that was gone through rests";
}

}  // namespace
}  // namespace asdic::detail::study
