#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "app/progress_painter.h"

// Lines of progress, in a log and on a terminal.

namespace asdic::detail::app {
namespace {

using std::chrono::milliseconds;

/// What is written to standard error in half a second of a run.
std::string written(bool terminal, PaintTimes times) {
  testing::internal::CaptureStderr();
  {
    int asked = 0;
    const ProgressPainter painter([&asked](double) { return "line " + std::to_string(++asked); },
                                  terminal, times);
    std::this_thread::sleep_for(milliseconds(500));
  }
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressPainter, WritesLinesIntoALog) {
  const std::string log = written(false, {milliseconds(20), milliseconds(40)});
  EXPECT_EQ(log.rfind("line 1\nline 2\n", 0), 0U) << log;
  EXPECT_EQ(log.find('\r'), std::string::npos) << "a log has no line drawn anew";
  EXPECT_LE(std::count(log.begin(), log.end(), '\n'), 13);
}

TEST(ProgressPainter, DrawsOneLineOnATerminalAndTakesItAway) {
  const std::string shown = written(true, {milliseconds(20), milliseconds(40)});
  EXPECT_EQ(shown.rfind("\r\x1b[Kline 1\r\x1b[Kline 2", 0), 0U) << shown;
  EXPECT_EQ(shown.find('\n'), std::string::npos);
  ASSERT_GT(shown.size(), 4U);
  EXPECT_EQ(shown.substr(shown.size() - 4), "\r\x1b[K");
}

TEST(ProgressPainter, SaysNothingOfAShortRun) {
  EXPECT_EQ(written(true, ProgressPainter::on_terminal), "");
  EXPECT_EQ(written(false, ProgressPainter::in_log), "");
}

// No run is silent for longer than a minute.
static_assert(ProgressPainter::in_log.first <= std::chrono::minutes(1) &&
              ProgressPainter::in_log.every <= std::chrono::minutes(1));

}  // namespace
}  // namespace asdic::detail::app
