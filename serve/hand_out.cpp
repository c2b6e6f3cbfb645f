#include "serve/hand_out.h"

#include "serve/answers.h"
#include "serve/sent_ping.h"

namespace asdic::detail::serve {

void hand_out(SessionState& session, std::int64_t until) {
  Listening& listening = *session.listening;
  while (!listening.is_over() && listening.position() < until) {
    if (listening.blocks()->scheduled && !session.replayed)
      send_scheduled(session, listening.next_end());
    listening.prepare(session, listening.next_end());
    if (auto block = listening.next()) session.tell(block_answer(std::move(*block), 0.0));
  }
  if (!listening.blocks() || !listening.is_over()) return;
  listening.end();
  session.tell({.line = listening_ended_line(listening.time())});
}

}  // namespace asdic::detail::serve
