#include "serve/connection_words.h"

#include "serve/refusal.h"
#include "serve/token.h"

namespace asdic::serve {

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

Answer handshake_too_late(const SessionLimits& limits) {
  return refusal_answer(
      "null", "handshake",
      refusal_text("first line", "none within " + std::to_string(limits.handshake_seconds) + " s",
                   "one sooner"),
      true);
}

Answer idle_too_long(const SessionLimits& limits) {
  return refusal_answer(
      "null", "idle",
      refusal_text("command", "none within " + std::to_string(limits.idle_seconds) + " s",
                   "one sooner"),
      true);
}

}  // namespace asdic::serve
