#pragma once
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

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
  /// \param taken  called with it before others see that it waits no more
  template <class Taken>
  std::optional<Command> pop(const Taken& taken) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !waiting_.empty(); });
    return take_first(taken);
  }

  /// The same, and none if none has come after a while.
  template <class Taken>
  std::optional<Command> pop_within(std::chrono::milliseconds most, const Taken& taken) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [&] { return closed_ || !waiting_.empty(); });
    return take_first(taken);
  }
  /// Whether no more come, and none is left.
  [[nodiscard]] bool over() const {
    const std::lock_guard lock(mutex_);
    return closed_ && waiting_.empty();
  }
  /// Whether all that wait are so.
  template <class Such>
  [[nodiscard]] bool all_of(const Such& such) const {
    const std::lock_guard lock(mutex_);
    return std::all_of(waiting_.begin(), waiting_.end(), such);
  }

  std::optional<Command> pop() {
    return pop([](const Command&) {});
  }

  /// Takes those out that are meant.
  template <class Meant>
  std::vector<Command> take_out(const Meant& meant) {
    const std::lock_guard lock(mutex_);
    std::vector<Command> out;
    std::deque<Command> stay;
    for (Command& one : waiting_) {
      if (meant(one))
        out.push_back(std::move(one));
      else
        stay.push_back(std::move(one));
    }
    waiting_ = std::move(stay);
    return out;
  }

  /// No more come; those that are there are still handed out.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  template <class Taken>
  std::optional<Command> take_first(const Taken& taken) {
    if (waiting_.empty()) return std::nullopt;
    Command command = std::move(waiting_.front());
    waiting_.pop_front();
    taken(command);
    return command;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Command> waiting_;
  std::size_t most_;
  bool closed_ = false;
};

}  // namespace asdic::detail::serve
