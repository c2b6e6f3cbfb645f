#include "serve/commands/cancel.h"

#include "serve/answers.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {

Answer CancelCommand::run(SessionState&, const Command& command) {
  static_cast<void>(meant(command));
  return answer(command, 0);
}

std::optional<std::string> CancelCommand::meant(const Command& command) {
  std::optional<std::string> id;
  for (const auto& [key, value] : std::get<TomlValue::Table>(command.fields.data)) {
    if (key != "of")
      throw Refusal("value", refusal_text(key, "an unknown key", "\"of\", the id of a command"));
    id = id_text(value);
    if (!id) throw Refusal("value", refusal_text("of", "something else", "the id of a command"));
  }
  return id;
}

Answer CancelCommand::answer(const Command& command, std::size_t number) {
  return {.line = cancel_line(command.id, number)};
}

}  // namespace asdic::detail::serve
