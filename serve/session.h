#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "serve/commands/commands.h"
#include "serve/session_state.h"

namespace asdic::detail::serve {

/// What one client does with a scenario: pings it, changes it, asks about it. Knows nothing of
/// sockets: takes lines, gives answers (docs/formats/serve.md).
class Session {
 public:
  /// \param clock  seconds of a clock that never goes back   \param commands  that there are
  /// \throws InputError if the scenario is wrong
  Session(const SessionSettings& settings, std::function<double()> clock,
          std::span<const AnyCommand> commands = all_commands);

  /// The answer to the handshake.
  [[nodiscard]] Answer greeting() const;
  /// A line's answer. Never throws for what a client says.
  [[nodiscard]] Answer answer(std::string_view line);

  /// How long until a command is to be carried out [s]: a ping at a later time by the clock.
  [[nodiscard]] double wait(const Command& command) const;
  [[nodiscard]] Answer execute(const Command& command);  ///< \throws Interrupted, NoRoom
  /// Whether it computes nothing to speak of: it needs no turn among others.
  [[nodiscard]] bool is_light(const Command& command) const { return known(command).light; }

  /// How room is made for an answer (SessionState::make_room).
  void makes_room(std::function<void(std::size_t bytes)> way) { state_.make_room = std::move(way); }

  /// What an answer leaves to be done after it. \return a refusal, if it could not be
  [[nodiscard]] std::optional<Answer> finish(const Command& command,
                                             const std::function<void()>& then);
  [[nodiscard]] SessionState& state() noexcept { return state_; }

  [[nodiscard]] const LatencyLog& latency() const noexcept { return state_.latency; }

 private:
  [[nodiscard]] Answer carry_out(const Command& command);
  [[nodiscard]] Answer guarded(const Command& command, const std::function<Answer()>& run);
  void log(const Command& command, double begun, bool ok);
  [[nodiscard]] const AnyCommand& known(const Command& command) const;

  SessionState state_;
  std::span<const AnyCommand> commands_;
  std::vector<std::string_view> names_;
};

/// A refusal as an answer. \param id  JSON
[[nodiscard]] Answer refusal_answer(const std::string& id, const std::string& code,
                                    const std::string& message, bool last = false);

}  // namespace asdic::detail::serve
