#include "app/interrupt.h"

#include <signal.h>

#include <array>
#include <atomic>
#include <chrono>
#include <utility>

#include "app/console.h"
#include "io/files/unfinished.h"
#include "raytrace/parallel/stop.h"

namespace asdic::detail::app {
namespace {

constexpr std::array<int, 3> stopping = {SIGINT, SIGTERM, SIGHUP};

std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only use such");

/// Of all that are not ignored: whoever started the program wants those ignored.
void on_all(void (*handler)(int)) {
  for (const int number : stopping) {
    struct sigaction action = {};
    if (sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
  }
}

extern "C" void on_last_signal(int number) {
  remove_unfinished();
  signal(number, SIG_DFL);
  raise(number);  // ends the program by the signal after this handler
}

extern "C" void on_signal(int) {
  signalled = true;
  on_all(on_last_signal);  // a second signal of any kind ends the program at once
}

}  // namespace

void end_cleanly_on_signals() { on_all(on_last_signal); }

Interrupt::Interrupt() {
  signalled = false;
  on_all(on_signal);
}

Interrupt::~Interrupt() { end_cleanly_on_signals(); }

bool Interrupt::requested() noexcept { return signalled; }

StopOnInterrupt::StopOnInterrupt() : StopOnInterrupt(std::string()) {}

StopOnInterrupt::StopOnInterrupt(std::string told) : told_(std::move(told)) {
  watcher_ = std::jthread([this](const std::stop_token& over) {
    std::unique_lock lock(mutex_);
    while (!over.stop_requested() && !signalled)
      over_.wait_for(lock, over, std::chrono::milliseconds(10), [] { return signalled.load(); });
    if (!signalled) return;
    if (!told_.empty()) app::tell(told_);
    stop_.request_stop();
  });
}

void StopOnInterrupt::tell(std::string told) {
  const std::lock_guard lock(mutex_);
  told_ = std::move(told);
}

StopOnInterrupt::~StopOnInterrupt() {
  watcher_.request_stop();
  watcher_.join();
}

void until_interrupted(const std::function<void()>& work) {
  const StopOnInterrupt interrupt;
  until_stopped(interrupt.token(), work);
}

}  // namespace asdic::detail::app
