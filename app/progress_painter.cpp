#include "app/progress_painter.h"

#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <utility>

#include "app/console.h"

namespace asdic::detail::app {
namespace {

void write(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

/// Draws until it is told to stop. \param terminal  each line in place of the one before
void paint(const std::stop_token& over, const ProgressPainter::Line& line, bool terminal,
           PaintTimes times) {
  using Clock = std::chrono::steady_clock;
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto start = Clock::now();
  bool shown = false;
  for (auto next = start + times.first; !over.stop_requested();) {
    stopped.wait_until(lock, over, next, [] { return false; });
    if (over.stop_requested()) break;
    const auto now = Clock::now();
    const std::string text = line(std::chrono::duration<double>(now - start).count());
    write(terminal ? "\r\x1b[K" + text : text + '\n');
    shown = true;
    next = now + times.every;
  }
  if (shown && terminal) write("\r\x1b[K");
}

}  // namespace

ProgressPainter::ProgressPainter(Line line, bool terminal, PaintTimes times)
    : thread_([line = std::move(line), terminal, times](const std::stop_token& over) {
        paint(over, line, terminal, times);
      }) {}

ProgressPainter::ProgressPainter(bool show, Line line) {
  if (!show) return;
  const bool terminal = stderr_is_terminal();
  thread_ = std::jthread([line = std::move(line), terminal](const std::stop_token& over) {
    paint(over, line, terminal, terminal ? on_terminal : in_log);
  });
}

ProgressPainter::~ProgressPainter() = default;  // asked to stop, and joined

}  // namespace asdic::detail::app
