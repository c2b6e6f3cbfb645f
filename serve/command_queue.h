#pragma once
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "serve/command.h"

namespace asdic::detail::serve {

/// Commands on their way from a connection's reader to its session: so many, and no more.
class CommandQueue {
 public:
  explicit CommandQueue(std::size_t most) : most_(most) {}

  /// \return whether there was room
  bool push(Command command) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= most_ || closed_) return false;
    waiting_.push_back(std::move(command));
    changed_.notify_all();
    return true;
  }

  [[nodiscard]] bool full() const {
    const std::lock_guard lock(mutex_);
    return waiting_.size() >= most_;
  }

  /// The next one; waits for it. None when the queue is closed and empty.
  std::optional<Command> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !waiting_.empty(); });
    if (waiting_.empty()) return std::nullopt;
    Command command = std::move(waiting_.front());
    waiting_.pop_front();
    return command;
  }

  /// The same, and none if none has come after a while.
  std::optional<Command> pop_within(std::chrono::milliseconds most) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, most, [&] { return closed_ || !waiting_.empty(); });
      if (waiting_.empty()) return std::nullopt;
    }
    return pop();
  }
  /// Whether no more come, and none is left.
  [[nodiscard]] bool over() const {
    const std::lock_guard lock(mutex_);
    return closed_ && waiting_.empty();
  }

  /// No more come; those that are there are still handed out.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Command> waiting_;
  std::size_t most_;
  bool closed_ = false;
};

}  // namespace asdic::detail::serve
