#include "serve/session_worker.h"

#include <algorithm>
#include <chrono>

#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"
#include "serve/answers.h"
#include "serve/sent_ping.h"

namespace asdic::detail::serve {
namespace {

constexpr std::chrono::seconds grace(1);  // for the command in hand when the server is stopped

}  // namespace

SessionWorker::SessionWorker(Engine& engine, Ways ways)
    : engine_(engine),
      ways_(std::move(ways)),
      queue_(engine.settings.limits.queued_pings),
      thread_([this] { run(); }) {}

SessionWorker::~SessionWorker() {
  stop();
  queue_.close();
}

bool SessionWorker::offer(Command command) {
  ++in_hand_;
  std::optional<Hold> hold;
  if (command.name == "ping" || command.name == "update")
    hold = Hold{.received = command.received, .said = number_said(command.fields, "time")};
  const std::lock_guard lock(mutex_);
  holds_.push_back(hold);
  if (queue_.push(std::move(command))) return true;
  holds_.pop_back();
  --in_hand_;
  return false;
}

/// The oldest command is done.
void SessionWorker::release() {
  {
    const std::lock_guard lock(mutex_);
    holds_.pop_front();
  }
  --in_hand_;
  wake_.notify_all();
}

void SessionWorker::stop() {
  const std::lock_guard lock(mutex_);  // so that who is about to wait sees it
  if (stopping_.exchange(true)) return;
  wake_.notify_all();
  grace_ = std::jthread([this](const std::stop_token& over) {
    std::mutex mutex;
    std::unique_lock waiting(mutex);
    std::condition_variable_any().wait_for(waiting, over, grace, [] { return false; });
    if (!over.stop_requested()) call_off_.request_stop();
  });
}

Answer SessionWorker::answer_to(Session& session, const Command& command) {
  try {
    Answer answer;
    until_stopped(call_off_.get_token(), [&] { answer = session.execute(command); });
    return answer;
  } catch (const Interrupted&) {
    return refusal_answer(command.id, "closing", "the server is being stopped");
  }
}

void SessionWorker::run() {
  try {
    serve();
  } catch (const std::exception& error) {
    if (turn_.owns_lock()) turn_.unlock();
    engine_.settings.report(error.what());
    ways_.deliver(refusal_answer("null", "run",
                                 "the session could not begin; the server's log says why", true));
  }
  queue_.close();
  while (const auto late = queue_.pop())
    ways_.deliver(refusal_answer(late->id, "closing", "the session has ended"));
  ways_.done();
}

void SessionWorker::serve() {
  Session session(engine_.settings, engine_.clock);
  ways_.deliver(session.greeting());
  begun_ = true;
  ways_.goes_on();
  session.state().tell = [this](Answer answer) {
    ways_.deliver(std::move(answer));
    turn_.unlock();
    const bool goes_on = wait_for_the_reader();
    turn_.lock();
    return goes_on;
  };
  std::jthread blocks;  // by the clock, of what is heard; it ends before the session does
  bool last = false;
  while (!last) {
    const auto command = next_command(session);
    if (!command) return;
    ways_.goes_on();
    if (wait(session.wait(*command)) && wait_for_the_reader())
      carry_out(session, *command, last);
    else
      ways_.deliver(refusal_answer(command->id, "closing", "the server is being stopped"));
    release();
    if (session.state().listening && engine_.settings.pace.by_the_clock() && !blocks.joinable())
      blocks =
          std::jthread([this, &session](const std::stop_token& over) { hand_out(session, over); });
  }
}

void SessionWorker::carry_out(Session& session, const Command& command, bool& last) {
  turn_ = std::unique_lock(engine_.busy);
  Answer answer = answer_to(session, command);
  last = answer.last;
  const std::function<void()> then = std::move(answer.then);
  ways_.deliver(std::move(answer));
  if (then) {
    try {
      std::optional<Answer> refused;
      until_stopped(call_off_.get_token(), [&] { refused = session.finish(command, then); });
      if (refused) ways_.deliver(std::move(*refused));
    } catch (const Interrupted&) {
      ways_.deliver(refusal_answer(command.id, "closing", "the server is being stopped"));
    }
  }
  turn_.unlock();
}

/// The next one; while somebody listens by the clock, what is heard before long is made meanwhile.
std::optional<Command> SessionWorker::next_command(Session& session) {
  for (;;) {
    const auto& listening = session.state().listening;
    if (!listening || !listening->blocks() || !engine_.settings.pace.by_the_clock())
      return queue_.pop();
    make_ahead(session);
    if (auto command = queue_.pop_within(std::chrono::milliseconds(20))) return command;
    if (queue_.over()) return std::nullopt;
  }
}

/// Pings of the schedule, and what changes have made of those that sound.
void SessionWorker::make_ahead(Session& session) {
  SessionState& state = session.state();
  Listening& listening = *state.listening;
  const auto blocks = listening.blocks();
  if (!blocks) return;
  const double heard = listening.time(),
               block = static_cast<double>(blocks->samples) / listening.rate();
  const double soon = heard + std::max(1.0, 4.0 * block);
  const double ahead = heard + state.live.state().scenario.pings.interval + block;
  const bool schedule =
      blocks->scheduled &&
      (!listening.is_prepared() || state.schedule.next(state.live.state().scenario).time < ahead);
  if (!schedule && !listening.lacks(soon)) return;
  turn_ = std::unique_lock(engine_.busy);
  try {
    std::optional<Answer> refused;
    until_stopped(call_off_.get_token(), [&] {
      refused = session.finish(Command{}, [&] {
        listening.prepare(state, soon);
        if (schedule) serve::send_scheduled(state, ahead);
      });
    });
    if (refused) {
      ways_.deliver(*refused);
      listening.end();
    }
  } catch (const Interrupted&) {
    listening.end();
  }
  turn_.unlock();
  wake_.notify_all();
}

/// Whether no command acts before a time of the scenario.
bool SessionWorker::may_be_heard(Session& session, double until) {
  const SessionState& state = session.state();
  return std::all_of(holds_.begin(), holds_.end(), [&](const auto& hold) {
    return !hold || hold->said.value_or(state.at(hold->received)) >= until;
  });
}

/// Blocks by the clock, each when its last sample is received and all that acts before it is done.
void SessionWorker::hand_out(Session& session, const std::stop_token& over) {
  SessionState& state = session.state();
  Listening& listening = *state.listening;
  const std::stop_callback wakes(over, [this] { wake_.notify_all(); });
  constexpr std::chrono::milliseconds a_while(100);
  bool heard = false;
  while (!over.stop_requested() && !stopping_) {
    if (!listening.blocks()) {
      if (heard) ways_.deliver({.line = listening_ended_line(listening.time())});
      heard = false;
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, a_while);
      continue;
    }
    heard = true;
    const double end = listening.next_end(), due = state.clock_at(end);
    {
      std::unique_lock lock(mutex_);
      if (const double early = due - engine_.clock(); early > 0.0) {
        wake_.wait_for(lock, std::min<std::chrono::duration<double>>(
                                 std::chrono::duration<double>(early), a_while));
        continue;
      }
      if (!may_be_heard(session, end) || !listening.is_prepared() || ways_.behind()) {
        wake_.wait_for(lock, std::chrono::milliseconds(5));
        continue;
      }
    }
    auto block = listening.next();
    if (!block) continue;
    ways_.deliver(block_answer(std::move(*block), std::max(0.0, engine_.clock() - due)));
  }
}

/// \return false if it is stopped before that
bool SessionWorker::wait(double seconds) {
  std::unique_lock lock(mutex_);
  if (seconds > 0.0)
    wake_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return stopping_.load(); });
  return !stopping_;
}

bool SessionWorker::wait_for_the_reader() {
  std::unique_lock lock(mutex_);
  while (!stopping_ && ways_.behind()) wake_.wait_for(lock, std::chrono::milliseconds(100));
  return !stopping_;
}

}  // namespace asdic::detail::serve
