#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace asdic::detail::app {

/// Makes SIGINT, SIGTERM and SIGHUP end the program at once, after they have removed its unfinished
/// files (io/files/unfinished.h). A signal that was ignored stays ignored.
void end_cleanly_on_signals();

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is noted, and the second ends the program at
/// once. One that was ignored stays so: SIGINT of a shell's job in the background, SIGHUP under
/// nohup. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] static bool requested() noexcept;
};

/// The same for what waits for a stop token: a thread watches what the handler has noted.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  /// \param told  a line on standard error when the first comes
  explicit StopOnInterrupt(std::string told);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

  /// From now on, the line on standard error when the first comes.
  void tell(std::string told);

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  Interrupt interrupt_;
  std::string told_;  ///< "": none
  std::stop_source stop_;
  std::mutex mutex_;
  std::condition_variable_any over_;  ///< wakes the watcher before its time
  std::jthread watcher_;
};

/// Does some work, which the first such signal ends (raytrace/parallel/stop.h). \throws Interrupted
/// if it did
void until_interrupted(const std::function<void()>& work);

}  // namespace asdic::detail::app
