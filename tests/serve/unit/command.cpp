#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "serve/command.h"
#include "serve/line_splitter.h"
#include "serve/refusal.h"

// Lines of clients: what is taken, and in what words the rest is refused.

namespace asdic::detail::serve {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& line, const SessionLimits& limits = {}) {
  try {
    static_cast<void>(read_command(line, limits));
    return "taken";
  } catch (const Refusal& refused) {
    return refused.code() + ": " + refused.what();
  }
}

TEST(Command, KeepsItsIdAndItsValues) {
  const Command ping = read_command(
      R"({"id": "a\"b", "command": "ping", "time": 2.5, "waveform": {"kind": "cw"}, "x": null})",
      {});
  EXPECT_EQ(ping.name, "ping");
  EXPECT_EQ(ping.id, R"("a\"b")");
  EXPECT_EQ(std::get<double>(ping.fields.find("time")->data), 2.5);
  EXPECT_EQ(std::get<std::string>(ping.fields.find("waveform")->find("kind")->data), "cw");
  EXPECT_EQ(ping.fields.find("x"), nullptr);  // null is like nothing
  EXPECT_EQ(ping.fields.find("id"), nullptr);
  EXPECT_EQ(read_command(R"({"id": 7, "command": "state"})", {}).id, "7");
  EXPECT_EQ(read_command(R"({"command": "quit"})", {}).id, "null");
}

TEST(Command, IsRefusedInOneMessage) {
  const std::string no_json =
      "json: line: found text that is no JSON in UTF-8, expected one JSON object a line";
  const struct {
    std::string line, message;
  } cases[] = {
      {"", no_json},
      {"   ", no_json},
      {"ping", no_json},
      {R"({"command": "ping")", no_json},
      {R"({"command": "ping"} {})", no_json},
      {"{\"command\": \"\xff\"}", no_json},
      {"{\"command\": \"\xc0\xaf\"}", no_json},  // overlong
      {R"({"command": "ping", "time": NaN})", no_json},
      {R"({"command": "ping", "time": Infinity})", no_json},
      {R"({"command": "ping", "time": 1e999})",
       "json: time: found a number that is not finite, expected finite numbers"},
      {R"({"command": "ping", "time": -1e999})",
       "json: time: found a number that is not finite, expected finite numbers"},
      {R"([1])", "json: line: found array, expected one JSON object a line"},
      {R"(1)", "json: line: found number, expected one JSON object a line"},
      {R"({"command": "ping", "time": 1, "time": 2})",
       "json: time: found the key twice, expected every key once"},
      {R"({"command": "ping", "waveform": {"kind": 1, "kind": 2}})",
       "json: kind: found the key twice, expected every key once"},
      {R"({})",
       R"(command: command: found nothing, expected "ping", "update", "listen", "state", "limits", "arrivals", "rays", "field", "levels", "save", "cancel" or "quit")"},
      {R"({"command": 5})",
       R"(command: command: found number, expected "ping", "update", "listen", "state", "limits", "arrivals", "rays", "field", "levels", "save", "cancel" or "quit")"},
      {R"({"command": "fire"})",
       R"(command: command: found an unknown one, expected "ping", "update", "listen", "state", "limits", "arrivals", "rays", "field", "levels", "save", "cancel" or "quit")"},
      {R"({"id": [1], "command": "ping"})",
       "command: id: found array, expected a number or a string"},
      {"{\"id\": \"" + std::string(200, 'x') + "\", \"command\": \"ping\"}",
       "command: id: found 202 bytes, expected at most 128"},
      {"{\"" + std::string(65, 'k') + "\": 1}",
       R"(json: line: found another key, expected keys of 1 to 64 letters, digits and "_")"},
      {R"({"": 1})",
       R"(json: line: found another key, expected keys of 1 to 64 letters, digits and "_")"},
      {R"({"a\u0000b": 1})",
       R"(json: line: found another key, expected keys of 1 to 64 letters, digits and "_")"},
  };
  for (const auto& one : cases) EXPECT_EQ(refusal(one.line), one.message) << one.line;
}

// A million brackets are refused at the seventeenth: no recursion follows them.
TEST(Command, NestingIsCountedWhileItIsRead) {
  const auto nested = [](std::size_t levels) {
    return R"({"command": "ping", "x": )" + std::string(levels - 1, '[') +
           std::string(levels - 1, ']') + "}";
  };
  EXPECT_EQ(refusal(nested(16)), "taken");
  EXPECT_EQ(refusal(nested(17)), "limit: x: found deeper nesting, expected at most 16 levels");
  SessionLimits large;
  large.line_bytes = 4'000'000;
  EXPECT_EQ(refusal(R"({"x": )" + std::string(1'000'000, '['), large),
            "limit: x: found deeper nesting, expected at most 16 levels");
}

TEST(Command, ALongLineIsRefused) {
  SessionLimits limits;
  limits.line_bytes = 30;
  EXPECT_EQ(refusal(R"({"command": "ping", "id": 12 })", limits), "taken");  // 30 bytes
  EXPECT_EQ(refusal(R"({"command": "ping", "id": 123 })", limits),
            "limit: line: found a longer one, expected at most 30 bytes a line");
}

TEST(Command, ARefusedLineStillHasItsId) {
  EXPECT_EQ(id_of(R"({"id": 5, "command": "fire"})", {}), "5");
  EXPECT_EQ(id_of(R"({"id": {"a": 1}})", {}), "null");
  // Whatever comes behind it.
  EXPECT_EQ(id_of(R"({"id": 5, "command")", {}), "5");
  EXPECT_EQ(id_of(R"({"id": 7, "command": "ping", "time": 1e999})", {}), "7");
  EXPECT_EQ(id_of(R"({"id": "a", "time": NaN})", {}), R"("a")");
  EXPECT_EQ(id_of(R"({"id": 7, "time": 1, "time": 2})", {}), "7");
  EXPECT_EQ(id_of(R"({"time": 1, "time": 2, "id": 7})", {}), "7");
  EXPECT_EQ(id_of(R"({"no such": 1, "id": 7.5})", {}), "7.5");
  EXPECT_EQ(id_of(R"({"x": {"id": 1}, "id": 7, "y": [{"id": 2}]})", {}), "7");
  EXPECT_EQ(id_of("{\"id\": 7, \"a\": " + std::string(100, '['), {}), "7");
  EXPECT_EQ(id_of("{\"a\": " + std::string(100, '[') + std::string(100, ']') + ", \"id\": 7}", {}),
            "7");
  EXPECT_EQ(id_of(R"({"id": 1, "id": 2})", {}), "null");
  EXPECT_EQ(id_of(R"([{"id": 1}])", {}), "null");
  EXPECT_EQ(id_of("{\"id\": \"" + std::string(200, 'a') + "\"}", {}), "null");
}

TEST(Handshake, IsTheFirstLine) {
  EXPECT_FALSE(read_handshake(R"({"asdic": 1})").waits);
  EXPECT_TRUE(read_handshake(R"({"asdic": 1, "when_full": "wait"})").waits);
  EXPECT_EQ(read_handshake(R"({"asdic": 1, "token": "abc"})").token, "abc");
}

TEST(Handshake, AnythingElseIsNotQuoted) {
  for (const std::string line :
       {"GET / HTTP/1.1", "", "{}", R"({"asdic": 2})", R"({"asdic": 1.0})", R"({"asdic": true})",
        R"({"asdic": "1"})", R"({"asdic": 1, "SECRET": 2})", R"({"asdic": 1, "token": 5})",
        R"({"asdic": 1, "when_full": "grow"})", R"({"asdic": 1, "asdic": 1})",
        R"({"command": "ping"})"}) {
    try {
      static_cast<void>(read_handshake(line));
      ADD_FAILURE() << "taken: " << line;
    } catch (const Refusal& refused) {
      EXPECT_EQ(refused.code(), "handshake");
      EXPECT_STREQ(refused.what(), R"(first line: found another, expected {"asdic": 1})") << line;
    }
  }
}

TEST(LineSplitter, PutsPiecesTogether) {
  LineSplitter splitter(10);
  std::string_view bytes = "ab";
  EXPECT_FALSE(splitter.take(bytes));
  bytes = "c\nde\n\nf";
  EXPECT_EQ(splitter.take(bytes)->text, "abc");
  EXPECT_EQ(splitter.take(bytes)->text, "de");
  EXPECT_EQ(splitter.take(bytes)->text, "");
  EXPECT_FALSE(splitter.take(bytes));
  EXPECT_TRUE(bytes.empty());
  EXPECT_EQ(splitter.rest()->text, "f");
  EXPECT_FALSE(splitter.rest());
}

TEST(LineSplitter, OfALongLineNothingIsKept) {
  LineSplitter splitter(4);
  std::string_view bytes = "1234\n12345\n1";
  EXPECT_EQ(splitter.take(bytes)->text, "1234");
  const auto line = splitter.take(bytes);
  EXPECT_TRUE(line->too_long);
  EXPECT_EQ(line->text, "");
  EXPECT_FALSE(splitter.take(bytes));
  for (int i = 0; i < 1000; ++i) {
    bytes = "123";
    EXPECT_FALSE(splitter.take(bytes));
  }
  bytes = "\nok\n";
  EXPECT_TRUE(splitter.take(bytes)->too_long);
  EXPECT_EQ(splitter.take(bytes)->text, "ok");
}

// Whatever pieces a text comes in, its lines are the same.
TEST(LineSplitter, PiecesDoNotMatter) {
  const std::string text = "one\ntwo two\n\nthree and more\nfour\n";
  for (std::size_t size = 1; size < text.size(); ++size) {
    LineSplitter splitter(9);
    std::string lines;
    for (std::size_t at = 0; at < text.size(); at += size) {
      std::string_view bytes = std::string_view(text).substr(at, size);
      while (!bytes.empty())
        if (const auto line = splitter.take(bytes))
          lines += (line->too_long ? "LONG" : line->text) + "|";
    }
    EXPECT_EQ(lines, "one|two two||LONG|four|") << size;
  }
}

}  // namespace
}  // namespace asdic::detail::serve
