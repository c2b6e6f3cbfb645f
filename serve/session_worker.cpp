#include "serve/session_worker.h"

#include <algorithm>
#include <chrono>

#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"
#include "serve/answers.h"
#include "serve/connection_words.h"
#include "serve/sent_ping.h"

namespace asdic::detail::serve {
namespace {

constexpr std::chrono::seconds grace(1);  // for the command in hand when the server is stopped

/// When a command acts, where that may be heard [s of the scenario].
std::optional<double> acts(const Command& command, const SessionState& session) {
  if (command.name != "ping" && command.name != "update") return std::nullopt;
  const auto said = number_said(command.fields, "time");
  return said ? *said : session.at(command.received);
}

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
  const bool a_command = current_ && !current_->id.empty();  // not what is made ahead
  const bool this_one = a_command && current_->why == Why::no && meant(current_->id);
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
  session.state().tell = [this](Answer answer) { tell(std::move(answer)); };
  carry_out_all(session);
  session.state().end_listening();
}

void SessionWorker::carry_out_all(Session& session) {
  std::jthread blocks;  // by the clock, of what is heard; it ends before the session does
  bool last = false;
  while (!last) {
    const auto command = next_command(session);
    if (!command) return;
    ways_.goes_on();
    Answer answer = carry_out(session, *command);
    last = answer.last;
    done();
    if (!answer.line.empty()) ways_.deliver(std::move(answer));
    ways_.release(std::exchange(reserved_, 0));
    --in_hand_;
    if (session.state().listening && engine_.settings.pace.by_the_clock() && !blocks.joinable())
      blocks =
          std::jthread([this, &session](const std::stop_token& over) { hand_out(session, over); });
  }
}

void SessionWorker::take(const Command& command, const SessionState& session) {
  const std::lock_guard lock(mutex_);
  current_.emplace().id = command.id;
  current_->acts = acts(command, session);
}

void SessionWorker::done() {
  {
    const std::lock_guard lock(mutex_);
    current_.reset();
  }
  wake_.notify_all();
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

/// Its turn to compute, from when it has it.
class SessionWorker::Turn {
 public:
  explicit Turn(SessionWorker& worker) : mine_(worker) {
    begin();
    mine_.turn_ = this;
  }
  ~Turn() {
    if (has_it_) give_back();
    mine_.turn_ = nullptr;
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  void give_back() {
    const double now = mine_.engine_.clock();
    {
      const std::lock_guard lock(mine_.mutex_);
      mine_.current_->since.reset();
      mine_.computed_.add(now - begun_, now);
    }
    mine_.engine_.turns.give_back();
    has_it_ = false;
  }
  /// After others. \return false if it was called off before
  bool take_again(const std::stop_token& off) {
    if (!mine_.engine_.turns.take(mine_.computed_, mine_.engine_.clock(), off)) return false;
    begin();
    return true;
  }

 private:
  void begin() {
    begun_ = mine_.engine_.clock();
    has_it_ = true;
    const std::lock_guard lock(mine_.mutex_);
    mine_.current_->since = begun_;
  }

  SessionWorker& mine_;
  double begun_ = 0.0;
  bool has_it_ = false;
};

/// When it is its turn. \throws Interrupted
Answer SessionWorker::compute(Session& session, const Command& command,
                              const std::stop_token& off) {
  const Turn turn(*this);
  Answer answer;
  bool is_done = false;
  try {
    until_stopped(off, [&] {
      answer = session.execute(command);
      is_done = !answer.then;
      if (answer.then) answer = finished(session, command, std::move(answer));
      is_done = true;
    });
  } catch (const Interrupted&) {
    if (!is_done) throw;  // else it was called off when nothing was left to call off
  }
  return answer;
}

/// Delivers an answer, and does what it leaves to be done. \return a refusal, or nothing
Answer SessionWorker::finished(Session& session, const Command& command, Answer answer) {
  const std::function<void()> then = std::move(answer.then);
  ways_.deliver(std::move(answer));
  return session.finish(command, then).value_or(Answer{});
}

/// What answers no command, within one. Others have a turn meanwhile. \throws Interrupted
void SessionWorker::tell(Answer answer) {
  const std::stop_token off = [&] {
    const std::lock_guard lock(mutex_);
    return current_->off.get_token();
  }();
  ways_.deliver(std::move(answer));
  turn_->give_back();
  if (!wait_for_the_reader(off) || !turn_->take_again(off)) throw Interrupted();
}

// Listening by the clock ------------------------------------------------------------------------

/// The next one; while somebody listens by the clock, what is heard before long is made meanwhile.
std::optional<Command> SessionWorker::next_command(Session& session) {
  const auto taken = [&](const Command& command) { take(command, session.state()); };
  for (;;) {
    const auto& listening = session.state().listening;
    if (!listening || !listening->blocks() || !engine_.settings.pace.by_the_clock())
      return queue_.pop(taken);
    make_ahead(session);
    if (auto command = queue_.pop_within(std::chrono::milliseconds(20), taken)) return command;
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
  const std::stop_token off = [&] {
    const std::lock_guard lock(mutex_);
    return current_.emplace().off.get_token();
  }();
  try {
    if (!engine_.turns.take(computed_, engine_.clock(), off)) throw Interrupted();
    const Turn turn(*this);
    until_stopped(off, [&] {
      const auto refused = session.finish(Command{}, [&] {
        listening.prepare(state, soon);
        if (schedule) send_scheduled(state, ahead);
      });
      if (!refused) return;
      ways_.deliver(*refused);
      state.end_listening();
    });
  } catch (const Interrupted&) {
    state.end_listening();
  }
  done();
}

/// Whether no command acts before a time of the scenario.
bool SessionWorker::may_be_heard(const SessionState& session, double until) {
  const auto later = [&](const std::optional<double>& time) { return !time || *time >= until; };
  // First those that wait: on its way in hand one is seen here or there.
  if (!queue_.all_of([&](const Command& one) { return later(acts(one, session)); })) return false;
  const std::lock_guard lock(mutex_);
  return !current_ || later(current_->acts);
}

/// Blocks by the clock, each when its last sample is received and all that acts before it is done.
void SessionWorker::hand_out(Session& session, const std::stop_token& over) {
  const SessionState& state = session.state();
  Listening& listening = *state.listening;
  const std::stop_callback wakes(over, [this] { wake_.notify_all(); });
  constexpr std::chrono::milliseconds a_while(100), a_moment(5);
  const auto wait_for = [&](std::chrono::duration<double> time) {
    std::unique_lock lock(mutex_);
    if (!over.stop_requested() && !stopping_) wake_.wait_for(lock, time);
  };
  bool heard = false;
  while (!over.stop_requested() && !stopping_) {
    if (!listening.blocks()) {
      if (heard) ways_.deliver({.line = listening_ended_line(listening.time())});
      heard = false;
      wait_for(a_while);
      continue;
    }
    heard = true;
    const double end = listening.next_end(), due = state.clock_at(end);
    const double early = due - engine_.clock();
    if (early > 0.0) {
      wait_for(
          std::min<std::chrono::duration<double>>(std::chrono::duration<double>(early), a_while));
    } else if (!listening.is_prepared() || ways_.behind()) {
      wait_for(a_moment);
    } else if (auto block = listening.next(
                   [&](double until) { return until == end && may_be_heard(state, until); })) {
      ways_.deliver(block_answer(std::move(*block), std::max(0.0, engine_.clock() - due)));
    } else if (listening.blocks()) {
      wait_for(a_moment);
    }
  }
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
