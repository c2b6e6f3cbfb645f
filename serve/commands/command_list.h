#pragma once
#include <concepts>
#include <string_view>

#include "serve/command.h"
#include "serve/session_state.h"

// What a command of a client's is: a struct in a file of its own, and its name in commands.h.
namespace asdic::detail::serve {

/// `name` is what clients say; run() carries it out and answers. \throws Refusal
template <class C>
concept ServeCommand = requires(SessionState& session, const Command& command) {
  { C::name } -> std::convertible_to<std::string_view>;
  { C::run(session, command) } -> std::same_as<Answer>;
};
/// One that may be carried out later: after how long [s].
template <class C>
concept WaitingCommand = requires(const SessionState& session, const Command& command) {
  { C::wait(session, command) } -> std::same_as<double>;
};

/// One that computes and writes nothing worth a turn says `light = true`.
template <class C>
concept LightCommand = C::light;

/// A command whose type is forgotten.
struct AnyCommand {
  std::string_view name;
  Answer (*run)(SessionState& session, const Command& command);
  double (*wait)(const SessionState& session, const Command& command);
  bool light = false;
};

template <ServeCommand C>
constexpr AnyCommand any_command() {
  AnyCommand made{.name = C::name, .run = &C::run, .wait = [](const SessionState&, const Command&) {
                    return 0.0;
                  }};
  if constexpr (WaitingCommand<C>) made.wait = &C::wait;
  if constexpr (LightCommand<C>) made.light = true;
  return made;
}

/// Of a command that has no keys of its own. \throws Refusal ("value") if there are any
void refuse_further_keys(const Command& command);

}  // namespace asdic::detail::serve
