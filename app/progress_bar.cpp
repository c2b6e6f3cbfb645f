#include "app/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/console.h"

namespace asdic::detail::app {

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
    : painter_(show, [this, thing = std::move(thing), total](double elapsed) {
        return progress_line(thing, done_, total, elapsed);
      }) {}

}  // namespace asdic::detail::app
