#include "app/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "app/console.h"

namespace asdic::app {

std::string progress_line(const std::string& thing, int done, int total, double elapsed) {
  constexpr int width = 30;
  const int filled = total > 0 ? static_cast<int>(std::int64_t{width} * done / total) : 0;
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(width, ' ');
  const std::string count =
      thing == "%" ? fmt::format("{} %", 100 * done / std::max(total, 1))
                   : fmt::format("{} of {}", done, count_of(std::size_t(total), thing));
  std::string line = fmt::format("[{}] {}, {}", bar, count, duration(std::max(elapsed, 0.1)));
  if (done > 0 && done < total) {
    const double left = elapsed * (total - done) / done;
    line += fmt::format(", about {} left", duration(std::max(left, 0.1)));
  }
  return line;
}

ProgressBar::ProgressBar(std::string thing, int total, bool show)
    : thing_(std::move(thing)), total_(total) {
  if (!show || !stderr_is_terminal()) return;
  painter_ = std::jthread([this](const std::stop_token& over) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    auto next = start + std::chrono::seconds(1);
    bool shown = false;
    while (!over.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const auto now = Clock::now();
      if (now < next) continue;
      draw(std::chrono::duration<double>(now - start).count());
      shown = true;
      next = now + std::chrono::milliseconds(250);
    }
    if (shown) std::fputs("\r\x1b[K", stderr);
  });
}

ProgressBar::~ProgressBar() = default;  // the painter is asked to stop, and joined

void ProgressBar::draw(double elapsed) const {
  std::fputs(("\r\x1b[K" + progress_line(thing_, done_, total_, elapsed)).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace asdic::app
