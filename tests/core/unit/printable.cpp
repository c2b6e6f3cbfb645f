#include "core/printable.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace asdic::detail {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  for (const char* text : {"", "10 dB re 1 µPa", "a \\ b", "Ångström, 深海, 🌊", "x = \"y\""})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatATerminalObeys) {
  EXPECT_EQ(printable("\x1b]0;title\a"), "\\x1b]0;title\\x07");
  EXPECT_EQ(printable("one\ntwo\r\tthree"), "one\\ntwo\\r\\tthree");
  EXPECT_EQ(printable("\x7f"), "\\u007f");
  EXPECT_EQ(printable("\u009b31m"), "\\u009b31m");        // C1: a control sequence as well
  EXPECT_EQ(printable("abc\u202edef"), "abc\\u202edef");  // would be read from right to left
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // not the shortest form
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate pair
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");           // cut off
  EXPECT_EQ(printable("\xf5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80");
}

TEST(Printable, TwiceIsOnce) {
  const std::string once = printable("\x1b[1m\n\xff\u202e");
  EXPECT_EQ(printable(once), once);
}

TEST(Printable, LinesStayLines) { EXPECT_EQ(printable_lines("one\n\ttwo\x1b"), "one\n\ttwo\\x1b"); }

TEST(Printable, InputErrorsAre) {
  const InputError error({.where = "a.h5", .got = "\"\x1b[31m\"", .expected = "a\nfile"});
  EXPECT_STREQ(error.what(), "a.h5: found \"\\x1b[31m\", expected a\\nfile");
}

}  // namespace
}  // namespace asdic::detail
