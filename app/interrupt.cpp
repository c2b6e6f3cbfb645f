#include "app/interrupt.h"

#include <signal.h>

#include <atomic>
#include <chrono>

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

}  // namespace

Interrupt::Interrupt() {
  signalled = false;
  on_both(on_signal);
  watcher_ = std::jthread([this](const std::stop_token& over) {
    std::unique_lock lock(mutex_);
    while (!over.stop_requested() && !signalled)
      over_.wait_for(lock, over, std::chrono::milliseconds(10), [] { return signalled.load(); });
    if (!signalled) return;
    on_both(SIG_DFL);  // after SIGINT a SIGTERM ends the program as well
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
