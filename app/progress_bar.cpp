#include "app/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/console.h"

namespace asdic::detail::app {

std::string progress_line(const BarState& state, double elapsed, std::size_t width) {
  const std::string time = duration(std::max(elapsed, 0.1));
  if (state.total <= 0) return cut_to(state.doing + ", " + time, width);
  const int whole = static_cast<int>(state.done);
  const double share = (state.done + state.in_hand) / state.total;
  std::vector<ProgressPart> parts;
  if (state.thing == "%")  // of long work each tenth
    parts.push_back({fmt::format("{:.{}f} %", 100.0 * share, elapsed > 10.0 ? 1 : 0), 0});
  else
    parts.push_back(
        {fmt::format("{} of {}", whole, count_of(std::size_t(state.total), state.thing)), 0});
  parts.push_back({time, 3});
  const double counted = elapsed - state.counted_from;
  if (state.done > 0.0 && state.done < state.total) {
    const double left = counted * (state.total - state.done) / state.done;
    parts.push_back({fmt::format("about {} left", duration(std::max(left, 0.1))), 1});
  }
  if (!state.doing.empty()) parts.push_back({state.doing, 2});
  return fitted_line(share, std::move(parts), width);
}

ProgressBar::ProgressBar(std::string thing, int total, bool show)
    : state_{.thing = std::move(thing), .total = total, .doing = {}},
      painter_(show, [this](double elapsed, std::size_t width) {
        const std::lock_guard lock(mutex_);
        elapsed_ = elapsed;
        return progress_line(state_, elapsed, width);
      }) {}

ProgressBar::ProgressBar(std::string doing, bool show) : ProgressBar(std::string(), 0, show) {
  this->doing(doing);
}

void ProgressBar::count(std::string thing, int total) {
  const std::lock_guard lock(mutex_);
  state_ = {.thing = std::move(thing), .total = total, .doing = {}, .counted_from = elapsed_};
}

void ProgressBar::done(double count, double in_hand) {
  const std::lock_guard lock(mutex_);
  state_.done = count;
  state_.in_hand = in_hand;
}

void ProgressBar::doing(std::string_view what) {
  const std::lock_guard lock(mutex_);
  state_.doing = what;
}

}  // namespace asdic::detail::app
