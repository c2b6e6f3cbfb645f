#include "core/utf8.h"

#include <gtest/gtest.h>

#include "core/text.h"

namespace asdic::detail {
namespace {

TEST(Utf8, IsCutBetweenCharacters) {
  const std::string text = "aé深🌊b";  // 1, 2, 3, 4 and 1 bytes
  const std::size_t ends[] = {0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10, 11, 11};
  for (std::size_t bytes = 0; bytes < std::size(ends); ++bytes) {
    EXPECT_EQ(cut_to_bytes(text, bytes), text.substr(0, ends[bytes])) << bytes;
    EXPECT_TRUE(is_utf8(cut_to_bytes(text, bytes)));
  }
}

TEST(Utf8, AnythingCanBeMadeUtf8) {
  EXPECT_EQ(as_utf8("aé深🌊b"), "aé深🌊b");
  EXPECT_EQ(as_utf8("r\xe9sum"), "r\uFFFDsum");  // Latin-1
  EXPECT_EQ(as_utf8("a\xc3"), "a\uFFFD");        // half of an é
}

// A message holds a name of any length completely.
TEST(Formatted, CutsNothing) {
  std::string name = "a";
  for (int i = 0; i < 5000; ++i) name += "é";
  EXPECT_EQ(formatted("\"%s\" %.3g m", name.c_str(), 1.5), '"' + name + "\" 1.5 m");
}

}  // namespace
}  // namespace asdic::detail
