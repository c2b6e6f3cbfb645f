#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace asdic::detail::serve {

/// Which stream has a way out of the server: one at a time.
class StreamTurn {
 public:
  /// \return false if another stream keeps it for longer than a moment: one whose last block is on
  /// its way is over in a moment
  [[nodiscard]] bool take() {
    std::unique_lock lock(mutex_);
    if (!free_.wait_for(lock, std::chrono::milliseconds(200), [&] { return !taken_; }))
      return false;
    taken_ = true;
    return true;
  }
  void give_back() {
    {
      const std::lock_guard lock(mutex_);
      taken_ = false;
    }
    free_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable free_;
  bool taken_ = false;
};

}  // namespace asdic::detail::serve
