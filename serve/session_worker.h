#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
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
  void run();
  void serve();
  Answer answer_to(Session& session, const Command& command);
  bool wait(double seconds);
  bool wait_for_the_reader();

  Engine& engine_;
  Ways ways_;
  CommandQueue queue_;
  std::atomic<std::size_t> in_hand_ = 0;
  std::atomic<bool> begun_ = false, stopping_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::stop_source call_off_;
  std::jthread grace_;   // calls off
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace asdic::detail::serve
