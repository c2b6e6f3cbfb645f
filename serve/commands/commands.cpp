#include "serve/commands/commands.h"

#include "serve/refusal.h"

namespace asdic::detail::serve {

std::span<const std::string_view> command_names() {
  static constexpr auto names = [] {
    std::array<std::string_view, all_commands.size()> made;
    for (std::size_t i = 0; i < made.size(); ++i) made[i] = all_commands[i].name;
    return made;
  }();
  return names;
}

void refuse_further_keys(const Command& command) {
  if (!std::get<TomlValue::Table>(command.fields.data).empty())
    throw Refusal("value", refusal_text(std::string(command.name), "further keys",
                                        "\"command\" and \"id\" alone"));
}

}  // namespace asdic::detail::serve
