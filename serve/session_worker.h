#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "serve/command_queue.h"
#include "serve/outbox.h"
#include "serve/session.h"
#include "serve/turns.h"

namespace asdic::detail::serve {

/// What the connections of a server share.
struct Engine {
  const SessionSettings& settings;
  std::function<double()> clock;      ///< [s], never goes back
  Turns turns;                        ///< one command at a time computes and writes files
  std::atomic<std::size_t> owed = 0;  ///< bytes of answers that readers have not taken
};

/// A session and the thread that carries out its commands, one after the other.
class SessionWorker {
 public:
  /// How it speaks to its connection; called in its thread, `deliver` also in that of cancel().
  struct Ways {
    std::function<void(Answer)> deliver;
    std::function<void()> goes_on;  ///< the session has begun, or there is room for a command again
    std::function<bool()> behind;   ///< whether the reader is so: then nothing new is begun
    /// Makes room for an answer, as Outbox; gives it back.
    std::function<Outbox::Room(std::size_t bytes)> reserve;
    std::function<void(std::size_t bytes)> release;
    bool waits = false;          ///< for room that others take, rather than be told "busy"
    std::function<void()> done;  ///< the last that is called
  };

  SessionWorker(Engine& engine, Ways ways);
  ~SessionWorker();  ///< waits for the thread
  SessionWorker(const SessionWorker&) = delete;
  SessionWorker& operator=(const SessionWorker&) = delete;

  /// \return whether there was room
  bool offer(Command command);
  [[nodiscard]] bool full() const { return queue_.full(); }
  [[nodiscard]] bool has_begun() const { return begun_; }
  [[nodiscard]] bool idle() const { return in_hand_ == 0; }  ///< no command waits, or is in hand

  /// Calls off the commands with an id, or all: those that wait, and the one in hand.
  /// \return how many
  std::size_t cancel(const std::optional<std::string>& id);
  /// Calls off the command in hand if its time is up.
  void check_time();

  void finish() { queue_.close(); }  ///< no more commands come
  /// Those that wait are refused; the one in hand is finished, or called off after a second.
  void stop();
  /// Nobody is there any more: the command in hand is called off at once.
  void abandon();
  void wake() { wake_.notify_all(); }  ///< the reader may have caught up

 private:
  /// Why a command was called off.
  enum class Why { no, cancelled, too_long, out_of_time, closing };
  /// The command that is carried out, or waits to be.
  struct InHand {
    std::string id;  ///< JSON; empty: it is no command, but what is made ahead of the clock
    std::stop_source off;
    Why why = Why::no;
    std::optional<double> since;  ///< it computes [s]
    /// When it acts: what is heard may go so far, and no further [s of the scenario].
    std::optional<double> acts;
  };
  class Turn;

  void run();
  void serve();
  void carry_out_all(Session& session);
  void take(const Command& command, const SessionState& session);
  void done();
  std::optional<Command> next_command(Session& session);
  void make_ahead(Session& session);
  void hand_out(Session& session, const std::stop_token& over);
  bool may_be_heard(const SessionState& session, double until);
  void tell(Answer answer);
  Answer carry_out(Session& session, const Command& command);
  Answer compute(Session& session, const Command& command, const std::stop_token& off);
  Answer finished(Session& session, const Command& command, Answer answer);
  Answer called_off(const Command& command);
  void call_off(Why why);  // under mutex_
  bool wait(double seconds, const std::stop_token& off);
  bool wait_for_the_reader(const std::stop_token& off);
  bool wait_for_room(const std::stop_token& off);
  void make_room(std::size_t bytes);

  Engine& engine_;
  Ways ways_;
  CommandQueue queue_;
  ComputedTime computed_;     // of this client; changed by its thread, under mutex_
  std::size_t reserved_ = 0;  // bytes, for the answer of the command in hand; of its thread
  std::atomic<std::size_t> in_hand_ = 0;
  std::atomic<bool> begun_ = false, stopping_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<InHand> current_;
  Turn* turn_ = nullptr;  // to compute; of the session's thread
  std::jthread grace_;    // calls off
  std::jthread thread_;   // last: it uses all the others
};

}  // namespace asdic::detail::serve
