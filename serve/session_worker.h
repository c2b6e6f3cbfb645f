#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "serve/command_queue.h"
#include "serve/session.h"

namespace asdic::detail::serve {

/// What the connections of a server share.
struct Engine {
  const SessionSettings& settings;
  std::function<double()> clock;  ///< [s], never goes back
  std::mutex busy;                ///< one command at a time computes and writes files
};

/// A session and the thread that carries out its commands, one after the other.
class SessionWorker {
 public:
  /// How it speaks to its connection; called in its thread.
  struct Ways {
    std::function<void(Answer)> deliver;
    std::function<void()> goes_on;  ///< the session has begun, or there is room for a command again
    std::function<bool()> behind;   ///< whether the reader is so: then nothing new is begun
    std::function<void()> done;     ///< the last that is called
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

  void finish() { queue_.close(); }  ///< no more commands come
  /// Those that wait are refused; the one in hand is finished, or called off after a second.
  void stop();
  void wake() { wake_.notify_all(); }  ///< the reader may have caught up

 private:
  /// When a command that is in hand, or waits, acts: what is heard may go so far, and no further.
  struct Hold {
    double received = 0.0;       ///< on the clock [s]
    std::optional<double> said;  ///< time of the scenario [s]
  };

  void run();
  void serve();
  void carry_out(Session& session, const Command& command, bool& last);
  std::optional<Command> next_command(Session& session);
  void make_ahead(Session& session);
  Answer answer_to(Session& session, const Command& command);
  bool wait(double seconds);
  bool wait_for_the_reader();
  void release();
  void hand_out(Session& session, const std::stop_token& over);
  bool may_be_heard(Session& session, double until);

  Engine& engine_;
  Ways ways_;
  CommandQueue queue_;
  std::atomic<std::size_t> in_hand_ = 0;
  std::atomic<bool> begun_ = false, stopping_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::optional<Hold>> holds_;  // of commands, in their order
  std::unique_lock<std::mutex> turn_;      // to compute, while a command is carried out
  std::stop_source call_off_;
  std::jthread grace_;   // calls off
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace asdic::detail::serve
