#include "serve/session_worker.h"

#include <chrono>

#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"

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
  if (queue_.push(std::move(command))) return true;
  --in_hand_;
  return false;
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
  bool last = false;
  while (!last) {
    const auto command = queue_.pop();
    if (!command) return;
    ways_.goes_on();
    if (wait(session.wait(*command)) && wait_for_the_reader()) {
      const std::lock_guard lock(engine_.busy);
      Answer answer = answer_to(session, *command);
      last = answer.last;
      ways_.deliver(std::move(answer));
    } else {
      ways_.deliver(refusal_answer(command->id, "closing", "the server is being stopped"));
    }
    --in_hand_;
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
