#include "serve/session.h"

#include <algorithm>
#include <new>

#include "raytrace/parallel/progress.h"
#include "serve/answers.h"

namespace asdic::detail::serve {

Answer refusal_answer(const std::string& id, const std::string& code, const std::string& message,
                      bool last) {
  return {.line = refusal_line(id, code, message), .samples = {}, .last = last, .refused = true};
}

Session::Session(const SessionSettings& settings, std::function<double()> clock,
                 std::span<const AnyCommand> commands)
    : state_(settings, std::move(clock)), commands_(commands) {
  for (const AnyCommand& command : commands_) names_.push_back(command.name);
}

Answer Session::greeting() const {
  return {.line = greeting_line(state_.live.state().scenario, state_.settings.pace,
                                state_.settings.provenance.program_version)};
}

Answer Session::answer(std::string_view line) {
  const SessionLimits& limits = state_.settings.limits;
  Command command;
  try {
    command = read_command(line, limits, names_);
    command.received = state_.clock();
  } catch (const Refusal& refusal) {
    return refusal_answer(id_of(line, limits), refusal.code(), refusal.what());
  }
  return execute(command);
}

const AnyCommand& Session::known(const Command& command) const {
  return *std::find_if(commands_.begin(), commands_.end(),
                       [&](const AnyCommand& one) { return one.name == command.name; });
}

void Session::log(const Command& command, double begun, bool ok) {
  if (state_.settings.log)
    state_.settings.log->write(
        state_.number, command,
        {.start = state_.start,
         .begun = begun,
         .done = state_.clock(),
         .acts = state_.acts,
         .heard = state_.heard ? std::optional(state_.heard->position) : std::nullopt},
        ok);
}

Answer Session::execute(const Command& command) {
  const double begun = state_.clock();
  state_.acts.reset();
  if (state_.listening) state_.heard = state_.listening->heard();
  if (command.acts)
    state_.acts = command.acts;
  else if (state_.settings.pace.by_the_clock())  // while it is listened to: when its line came
    state_.acts = state_.listening ? state_.at(command.received) : state_.now();
  struct Over {
    ~Over() { acts.reset(); }
    std::optional<double>& acts;
  } over{state_.acts};
  try {
    Answer answer = carry_out(command);
    log(command, begun, !answer.refused);
    return answer;
  } catch (const Interrupted&) {
    log(command, begun, false);
    throw;
  }
}

Answer Session::carry_out(const Command& command) {
  return guarded(command, [&] {
    Answer answer = known(command).run(state_, command);
    if (const std::size_t most = state_.settings.limits.answer_bytes; answer.line.size() > most)
      throw Refusal("limit", refusal_text(std::string(command.name), "a longer answer",
                                          "at most " + std::to_string(most) + " bytes"));
    return answer;
  });
}

std::optional<Answer> Session::finish(const Command& command, const std::function<void()>& then) {
  Answer answer = guarded(command, [&] {
    then();
    return Answer{};
  });
  if (answer.line.empty()) return std::nullopt;
  return answer;
}

Answer Session::guarded(const Command& command, const std::function<Answer()>& run) {
  try {
    return run();
  } catch (const Refusal& refusal) {
    return refusal_answer(command.id, refusal.code(), refusal.what());
  } catch (const MemoryError& error) {
    return refusal_answer(command.id, "limit", error.what());
  } catch (const InputError& error) {  // out of building a simulator
    const Refusal refusal = state_.live.refusal(error, command.fields);
    return refusal_answer(command.id, refusal.code(), refusal.what());
  } catch (const std::bad_alloc&) {
    return refusal_answer(command.id, "run", "not enough memory for this ping");
  } catch (const Interrupted&) {  // the worker knows why
    throw;
  } catch (const std::exception& error) {
    state_.settings.report(error.what());
    return refusal_answer(command.id, "run", "it could not be done; the server's log says why");
  }
}

double Session::wait(const Command& command) const { return known(command).wait(state_, command); }

}  // namespace asdic::detail::serve
