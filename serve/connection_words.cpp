#include "serve/connection_words.h"

#include "serve/refusal.h"
#include "serve/token.h"

namespace asdic::detail::serve {

Handshake checked_handshake(const std::string& line, const std::string& token) {
  Handshake shake = read_handshake(line);
  if (!token.empty() && !same_secret(shake.token, token))
    throw Refusal("token",
                  refusal_text("token", shake.token.empty() ? "none" : "another", "the server's"));
  return shake;
}

Answer line_too_long(const SessionLimits& limits) {
  return refusal_answer(
      "null", "limit",
      refusal_text("line", "a longer one",
                   "at most " + std::to_string(limits.line_bytes) + " bytes a line"));
}

Answer queue_full(const std::string& id, const SessionLimits& limits) {
  return refusal_answer(
      id, "busy",
      refusal_text("queue", std::to_string(limits.queued_pings) + " commands waiting",
                   "fewer: wait for an answer"));
}

Answer command_cancelled(const std::string& id) {
  return refusal_answer(id, "cancelled", "the command was cancelled");
}

Answer command_too_long(const std::string& id, const SessionLimits& limits) {
  return refusal_answer(
      id, "limit",
      refusal_text("command_seconds", "a command that takes longer, which was called off",
                   "at most " + std::to_string(limits.command_seconds) + " s of computing"));
}

Answer client_too_long(const std::string& id, const SessionLimits& limits) {
  return refusal_answer(
      id, "limit",
      refusal_text("client_seconds", "none left, and a command that was called off or not begun",
                   "at most " + std::to_string(limits.client_seconds) +
                       " s of computing of a client in all"));
}

Refusal answers_wait(const SessionLimits& limits) {
  return {"busy", refusal_text("total_answer_bytes", "answers that other clients have not taken",
                               "less than " + std::to_string(limits.total_answer_bytes) +
                                   " bytes of them: try again later")};
}

Answer no_place(const SessionLimits& limits) {
  return refusal_answer("null", "limit",
                        refusal_text("server", std::to_string(limits.connections) + " connections",
                                     "fewer: try again later"),
                        true);
}

namespace {

Answer too_late(const char* code, const char* what, std::size_t seconds) {
  return refusal_answer(
      "null", code,
      refusal_text(what, "none within " + std::to_string(seconds) + " s", "one sooner"), true);
}

}  // namespace

Answer handshake_too_late(const SessionLimits& limits) {
  return too_late("handshake", "first line", limits.handshake_seconds);
}

Answer idle_too_long(const SessionLimits& limits) {
  return too_late("idle", "command", limits.idle_seconds);
}

}  // namespace asdic::detail::serve
