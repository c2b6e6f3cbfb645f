#include "watched.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

namespace asdic::python {
namespace {

constexpr std::chrono::milliseconds look_at_signals{50};
constexpr int spins = 2000;  // some µs, before the waiting thread sleeps

/// A thread that does one piece of work after the other: to start one takes longer than to find
/// paths in an ocean that is known.
class Worker {
 public:
  Worker() : thread_([this](const std::stop_token& end) { serve(end); }) {}
  ~Worker() {
    thread_.request_stop();
    wake_.notify_all();
  }

  void begin(std::function<void()> job) {
    done_ = false;
    {
      const std::scoped_lock lock(mutex_);
      job_ = std::move(job);
    }
    wake_.notify_one();
  }
  /// \return whether it is done; waits a moment
  bool wait() {
    for (int i = 0; i < spins; ++i) {
      if (done_) return true;
      if (i % 16 == 0) std::this_thread::yield();
    }
    std::unique_lock lock(mutex_);
    return over_.wait_for(lock, look_at_signals, [this] { return done_.load(); });
  }

 private:
  void serve(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    while (!end.stop_requested()) {
      wake_.wait(lock, [&] { return job_ || end.stop_requested(); });
      if (!job_) continue;
      const std::function<void()> job = std::exchange(job_, {});
      lock.unlock();
      job();
      lock.lock();
      done_ = true;
      over_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, over_;
  std::function<void()> job_;
  std::atomic<bool> done_ = false;
  std::jthread thread_;
};

/// That of the main thread. A process that was forked has none of its parent's threads.
Worker& worker() {
  static Worker* mine = nullptr;
  static pid_t process = 0;
  if (process != ::getpid()) mine = new Worker, process = ::getpid();
  return *mine;
}

bool in_main_thread() {
  static const py::handle threading = py::module_::import("threading").release();  // outlives all
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

/// Hands it on with the interpreter; what it raises ends the work.
std::function<void(int, int)> told(const py::object& progress, std::stop_source& stop,
                                   std::exception_ptr& fault) {
  if (progress.is_none()) return {};
  return [&](int done, int total) {
    const py::gil_scoped_acquire held;
    if (fault) return;
    try {
      progress(done, total);
    } catch (...) {
      fault = std::current_exception();
      stop.request_stop();
    }
  };
}

}  // namespace

void run_watched(const std::function<void(const Watch&)>& work, const py::object& progress) {
  static std::atomic<bool> busy = false;  // a callback of the work may call us again
  std::stop_source stop;
  std::exception_ptr fault, raised;
  const Watch watch{.stop = stop.get_token(), .progress = told(progress, stop, raised)};
  const bool main = in_main_thread() && !busy.exchange(true);
  const auto job = [&] {
    try {
      work(watch);
    } catch (...) {
      fault = std::current_exception();
    }
  };
  {
    const py::gil_scoped_release released;
    if (!main) {
      job();
    } else {
      Worker& mine = worker();
      mine.begin(job);
      while (!mine.wait()) {
        if (raised) continue;
        const py::gil_scoped_acquire held;
        if (PyErr_CheckSignals() == 0) continue;
        raised = std::make_exception_ptr(py::error_already_set());
        stop.request_stop();
      }
    }
  }
  if (main) busy = false;
  if (raised) std::rethrow_exception(raised);
  if (fault) std::rethrow_exception(fault);
}

}  // namespace asdic::python
