#include "serve/session_worker.h"

#include <chrono>

#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"
#include "serve/connection_words.h"

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

// Calling off -----------------------------------------------------------------------------------

void SessionWorker::call_off(Why why) {
  if (!current_ || current_->why != Why::no) return;
  current_->why = why;
  current_->off.request_stop();
  wake_.notify_all();
}

std::size_t SessionWorker::cancel(const std::optional<std::string>& id) {
  const auto meant = [&](const std::string& one) { return !id || one == *id; };
  const auto waiting = queue_.take_out([&](const Command& one) { return meant(one.id); });
  for (const Command& one : waiting) {
    ways_.deliver(command_cancelled(one.id));
    --in_hand_;
  }
  if (!waiting.empty()) ways_.goes_on();
  const std::lock_guard lock(mutex_);
  const bool this_one = current_ && current_->why == Why::no && meant(current_->id);
  if (this_one) call_off(Why::cancelled);
  return waiting.size() + (this_one ? 1 : 0);
}

void SessionWorker::check_time() {
  const SessionLimits& limits = engine_.settings.limits;
  const std::lock_guard lock(mutex_);
  if (!current_ || !current_->since) return;
  const double took = engine_.clock() - *current_->since;
  if (took > double(limits.command_seconds)) call_off(Why::too_long);
  if (computed_.in_all() + took > double(limits.client_seconds)) call_off(Why::out_of_time);
}

void SessionWorker::stop() {
  const std::lock_guard lock(mutex_);  // so that who is about to wait sees it
  if (stopping_.exchange(true)) return;
  wake_.notify_all();
  grace_ = std::jthread([this](const std::stop_token& over) {
    std::mutex mutex;
    std::unique_lock waiting(mutex);
    std::condition_variable_any().wait_for(waiting, over, grace, [] { return false; });
    if (over.stop_requested()) return;
    const std::lock_guard now(mutex_);
    call_off(Why::closing);
  });
}

void SessionWorker::abandon() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  call_off(Why::closing);
  wake_.notify_all();
}

Answer SessionWorker::called_off(const Command& command) {
  const std::lock_guard lock(mutex_);
  switch (current_->why) {
    case Why::cancelled:
      return command_cancelled(command.id);
    case Why::too_long:
      return command_too_long(command.id, engine_.settings.limits);
    case Why::out_of_time:
      return client_too_long(command.id, engine_.settings.limits);
    default:
      return refusal_answer(command.id, "closing", "the server is being stopped");
  }
}

// Carrying out ----------------------------------------------------------------------------------

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
  session.makes_room([this](std::size_t bytes) { make_room(bytes); });
  ways_.deliver(session.greeting());
  begun_ = true;
  ways_.goes_on();
  bool last = false;
  while (!last) {
    const auto command = queue_.pop([this](const Command& taken) { take(taken); });
    if (!command) return;
    ways_.goes_on();
    Answer answer = carry_out(session, *command);
    last = answer.last;
    {
      const std::lock_guard lock(mutex_);
      current_.reset();
    }
    ways_.deliver(std::move(answer));
    ways_.release(std::exchange(reserved_, 0));
    --in_hand_;
  }
}

void SessionWorker::take(const Command& command) {
  const std::lock_guard lock(mutex_);
  current_.emplace().id = command.id;
}

Answer SessionWorker::carry_out(Session& session, const Command& command) {
  const std::stop_token off = [&] {
    const std::lock_guard lock(mutex_);
    return current_->off.get_token();
  }();
  try {
    if (!wait(session.wait(command), off) || !wait_for_the_reader(off)) return called_off(command);
    if (session.is_light(command)) return session.execute(command);
    if (computed_.in_all() >= double(engine_.settings.limits.client_seconds))
      return client_too_long(command.id, engine_.settings.limits);
    for (;;) {
      if (!engine_.turns.take(computed_, engine_.clock(), off)) return called_off(command);
      try {
        return compute(session, command, off);
      } catch (const NoRoom&) {  // it was asked for before anything was made
        if (!wait_for_room(off)) return called_off(command);
      }
    }
  } catch (const Interrupted&) {
    return called_off(command);
  }
}

/// When it is its turn. \throws Interrupted
Answer SessionWorker::compute(Session& session, const Command& command,
                              const std::stop_token& off) {
  struct Turn {
    explicit Turn(SessionWorker& worker) : mine(worker), begun(worker.engine_.clock()) {
      const std::lock_guard lock(mine.mutex_);
      mine.current_->since = begun;
    }
    ~Turn() {
      const double now = mine.engine_.clock();
      {
        const std::lock_guard lock(mine.mutex_);
        mine.current_->since.reset();
        mine.computed_.add(now - begun, now);
      }
      mine.engine_.turns.give_back();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    SessionWorker& mine;
    double begun;
  };
  const Turn turn(*this);
  Answer answer;
  bool done = false;
  try {
    until_stopped(off, [&] {
      answer = session.execute(command);
      done = true;
    });
  } catch (const Interrupted&) {
    if (!done) throw;  // else it was called off when nothing was left to call off
  }
  return answer;
}

bool SessionWorker::wait_for_room(const std::stop_token& off) {
  std::unique_lock lock(mutex_);
  const auto over = [&] { return stopping_ || off.stop_requested(); };
  if (!over()) wake_.wait_for(lock, std::chrono::milliseconds(500));
  return !over();
}

void SessionWorker::make_room(std::size_t bytes) {
  switch (ways_.reserve(bytes)) {
    case Outbox::Room::here:
      reserved_ += bytes;
      return;
    case Outbox::Room::taken_by_others:
      if (!ways_.waits) throw answers_wait(engine_.settings.limits);
      [[fallthrough]];
    default:
      throw NoRoom{bytes};
  }
}

/// \return false if the command is called off, or the server is stopped, before that
bool SessionWorker::wait(double seconds, const std::stop_token& off) {
  std::unique_lock lock(mutex_);
  const auto over = [&] { return stopping_ || off.stop_requested(); };
  if (seconds > 0.0) wake_.wait_for(lock, std::chrono::duration<double>(seconds), over);
  return !over();
}

bool SessionWorker::wait_for_the_reader(const std::stop_token& off) {
  std::unique_lock lock(mutex_);
  const auto over = [&] { return stopping_ || off.stop_requested(); };
  while (!over() && ways_.behind()) wake_.wait_for(lock, std::chrono::milliseconds(100));
  return !over();
}

}  // namespace asdic::detail::serve
