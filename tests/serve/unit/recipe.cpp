#include <gtest/gtest.h>

#include "serve/commands/commands.h"
#include "support/serve.h"

// The example of docs/develop/recipes.md: a new command of `asdic serve`.

namespace asdic::detail::serve {
namespace {

/// The example: tells how many pings have been sent.
struct CountCommand {
  static constexpr std::string_view name = "count";
  static Answer run(SessionState& session, const Command& command) {
    refuse_further_keys(command);
    return {.line = R"({"id": )" + command.id + R"(, "ok": true, "pings": )" +
                    std::to_string(session.pings) + '}'};
  }
};

TEST(Recipe, ACommandIsAFileAndAWord) {
  const SessionSettings settings{
      .scenario = {.text = support::served_scenario, .path = "sea.toml", .overrides = {}}};
  Session session(
      settings, [] { return 0.0; }, command_list<PingCommand, CountCommand>);
  const auto said = [&](const char* line) {
    return nlohmann::json::parse(session.answer(line).line);
  };
  EXPECT_EQ(said(R"({"command": "count"})")["pings"], 0);
  EXPECT_EQ(said(R"({"command": "ping"})")["ok"], true);
  EXPECT_EQ(said(R"({"command": "count", "id": 7})")["pings"], 1);
  EXPECT_EQ(said(R"({"command": "count", "of": 1})")["error"]["code"], "value");
  EXPECT_EQ(said(R"({"command": "state"})")["error"]["message"],
            R"(command: found an unknown one, expected "ping" or "count")");
}

}  // namespace
}  // namespace asdic::detail::serve
