#pragma once
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace asdic::app {

/// While it lives, the first SIGINT or SIGTERM asks for a stop, and the second ends the program at
/// once. One at a time.
///
/// The handler only sets an atomic; a thread that watches it requests the stop.
class Interrupt {
 public:
  /// \param told  a line on standard error when the first comes; "": none
  explicit Interrupt(std::string told = {});
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
  [[nodiscard]] static bool requested() noexcept;

 private:
  std::stop_source stop_;
  std::mutex mutex_;
  std::condition_variable_any over_;  ///< wakes the watcher before its time
  std::jthread watcher_;
};

}  // namespace asdic::app
