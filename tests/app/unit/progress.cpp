#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "app/console.h"
#include "app/progress_painter.h"

// Lines of progress, in a log and on a terminal.

namespace asdic::detail::app {
namespace {

using std::chrono::milliseconds;

/// What is written to standard error in a run that takes so long.
std::string written(bool terminal, PaintTimes times, milliseconds takes = milliseconds(500)) {
  testing::internal::CaptureStderr();
  {
    int asked = 0;
    const ProgressPainter painter(
        [&asked](double, std::size_t) { return "line " + std::to_string(++asked); }, terminal,
        times);
    std::this_thread::sleep_for(takes);
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
  EXPECT_EQ(written(true, ProgressPainter::on_terminal, milliseconds(20)), "");
  EXPECT_EQ(written(false, ProgressPainter::in_log, milliseconds(20)), "");
}

// What is said meanwhile stands in a line of its own, and the line of progress below it.
TEST(ProgressPainter, MakesRoomForWhatIsSaid) {
  testing::internal::CaptureStderr();
  {
    const ProgressPainter painter([](double, std::size_t) { return "half way"; }, true,
                                  {milliseconds(10), milliseconds(20)});
    std::this_thread::sleep_for(milliseconds(200));
    tell("asdic: warning: deep");
    std::this_thread::sleep_for(milliseconds(200));
  }
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_NE(shown.find("\r\x1b[Khalf way\r\x1b[Kasdic: warning: deep\n\r\x1b[Khalf way"),
            std::string::npos)
      << shown;
}

TEST(FittedLine, FitsIntoAnyWidth) {
  const std::vector<ProgressPart> parts{{"12 of 4000 realisations", 0},
                                        {"3.20 s", 3},
                                        {"4.1/s", 4},
                                        {"about 16 min 12 s left", 1},
                                        {"pd 0.83 (0.80 to 0.86 at 95 %)", 2}};
  for (std::size_t width = 1; width < 200; ++width)
    EXPECT_LE(columns_of(fitted_line(0.3, parts, width)), width);
  EXPECT_EQ(fitted_line(0.5, parts, 200),
            "[###############               ] 12 of 4000 realisations, 3.20 s, 4.1/s, about 16 min "
            "12 s left, pd 0.83 (0.80 to 0.86 at 95 %)");
  const std::string of_77 = fitted_line(0.5, parts, 77);
  EXPECT_EQ(of_77.find("4.1/s"), std::string::npos) << of_77;
  EXPECT_NE(of_77.find("about 16 min 12 s left"), std::string::npos) << of_77;
  EXPECT_EQ(fitted_line(0.5, parts, 12), "12 of 4000 …");
}

TEST(Wrapped, BreaksAtSpacesAndKeepsWords) {
  EXPECT_EQ(wrapped("  one two three", 9, 2), "  one two\n  three\n");
  EXPECT_EQ(wrapped("asdic ping a.toml -o b", 12, 4, " \\"),
            "asdic ping \\\n    a.toml \\\n    -o b\n");
  EXPECT_EQ(wrapped("incomprehensible", 5, 0), "incomprehensible\n");
  EXPECT_EQ(wrapped("", 5, 0), "\n");
}

// A line moves within the first second; no run is silent for longer than a minute.
static_assert(ProgressPainter::on_terminal.first + ProgressPainter::on_terminal.every <
              std::chrono::seconds(1));
static_assert(ProgressPainter::in_log.first <= std::chrono::minutes(1) &&
              ProgressPainter::in_log.every <= std::chrono::minutes(1));

}  // namespace
}  // namespace asdic::detail::app
