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

extern "C" void on_signal(int) { signalled = true; }

void on(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);  // the second is not ours
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

void on_both(void (*handler)(int)) {
  on(SIGINT, handler);
  on(SIGTERM, handler);
}

/// In place of a progress bar's line, which is drawn anew below.
void say(const std::string& line) {
  std::fputs(((stderr_is_terminal() ? "\r\x1b[K" : "") + line + '\n').c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

Interrupt::Interrupt(std::string told) {
  signalled = false;
  on_both(on_signal);
  watcher_ = std::jthread([this, told = std::move(told)](const std::stop_token& over) {
    std::unique_lock lock(mutex_);
    while (!over.stop_requested() && !signalled)
      over_.wait_for(lock, over, std::chrono::milliseconds(10), [] { return signalled.load(); });
    if (!signalled) return;
    on_both(SIG_DFL);  // after SIGINT a SIGTERM ends the program as well
    if (!told.empty()) say(told);
    stop_.request_stop();
  });
}

Interrupt::~Interrupt() {
  watcher_.request_stop();
  watcher_.join();
  on_both(SIG_DFL);
}

bool Interrupt::requested() noexcept { return signalled; }

}  // namespace asdic::app
