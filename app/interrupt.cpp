#include "app/interrupt.h"

#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <utility>

#include "app/console.h"

namespace asdic::app {
namespace {

std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only use such");

void on_both(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

extern "C" void on_signal(int) {
  signalled = true;
  on_both(SIG_DFL);  // the second is not ours, whichever it is
}

/// In place of a progress bar's line, which is drawn anew below.
void say(const std::string& line) {
  std::fputs(((stderr_is_terminal() ? "\r\x1b[K" : "") + line + '\n').c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

Interrupt::Interrupt() {
  signalled = false;
  on_both(on_signal);
}

Interrupt::~Interrupt() { on_both(SIG_DFL); }

bool Interrupt::requested() noexcept { return signalled; }

StopOnInterrupt::StopOnInterrupt(std::string told) {
  watcher_ = std::jthread([this, told = std::move(told)](const std::stop_token& over) {
    std::unique_lock lock(mutex_);
    while (!over.stop_requested() && !signalled)
      over_.wait_for(lock, over, std::chrono::milliseconds(10), [] { return signalled.load(); });
    if (!signalled) return;
    if (!told.empty()) say(told);
    stop_.request_stop();
  });
}

StopOnInterrupt::~StopOnInterrupt() {
  watcher_.request_stop();
  watcher_.join();
}

}  // namespace asdic::app
