#include "app/progress_painter.h"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>

#include "app/console.h"

namespace asdic::detail::app {
namespace {

// After Ctrl-C a terminal writes "^C" behind the line: that must not begin another one.
constexpr std::size_t room_at_the_end = 3;

/// Draws until it is told to stop. \param terminal  each line in place of the one before
void paint(const std::stop_token& over, const ProgressPainter::Line& line, bool terminal,
           PaintTimes times) {
  using Clock = std::chrono::steady_clock;
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto start = Clock::now();
  for (auto next = start + times.first; !over.stop_requested();) {
    stopped.wait_until(lock, over, next, [] { return false; });
    if (over.stop_requested()) break;
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start).count();
    if (terminal)
      draw_progress(line(elapsed, terminal_width(STDERR_FILENO) - room_at_the_end));
    else
      tell(line(elapsed, ProgressPainter::width_of_log));
    next = now + times.every;
  }
  if (terminal) draw_progress("");
}

}  // namespace

ProgressPainter::ProgressPainter(Line line, bool terminal, PaintTimes times)
    : thread_([line = std::move(line), terminal, times](const std::stop_token& over) {
        paint(over, line, terminal, times);
      }) {}

ProgressPainter::ProgressPainter(bool show, Line line) {
  if (!show) return;
  const char* const kind = std::getenv("TERM");
  const bool dumb = kind != nullptr && std::string_view(kind) == "dumb";  // clears no line
  const bool terminal = stderr_is_terminal() && !dumb;
  thread_ = std::jthread([line = std::move(line), terminal](const std::stop_token& over) {
    paint(over, line, terminal, terminal ? on_terminal : in_log);
  });
}

ProgressPainter::~ProgressPainter() = default;  // asked to stop, and joined

std::string fitted_line(double share, std::vector<ProgressPart> parts, std::size_t width) {
  constexpr std::size_t longest_bar = 30, shortest_bar = 10, around_it = 3;  // "[", "] "
  const std::size_t bar = shortest_bar + around_it;
  // a bar, if there is room for the first part beside it
  const std::size_t room = parts.empty() || columns_of(parts.front().text) + bar <= width ? bar : 0;
  std::string text;
  for (;;) {
    text.clear();
    for (const ProgressPart& part : parts) text += (text.empty() ? "" : ", ") + part.text;
    if (columns_of(text) + room <= width || parts.size() < 2) break;
    parts.erase(std::max_element(parts.begin(), parts.end(),
                                 [](const auto& a, const auto& b) { return a.rank < b.rank; }));
  }
  const std::size_t taken = columns_of(text) + around_it;
  if (taken + shortest_bar > width) return cut_to(text, width);
  const std::size_t length = std::min(longest_bar, width - taken);
  const auto filled = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * double(length));
  return '[' + std::string(filled, '#') + std::string(length - filled, ' ') + "] " + text;
}

}  // namespace asdic::detail::app
