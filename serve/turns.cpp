#include "serve/turns.h"

#include <cmath>

namespace asdic::detail::serve {
namespace {

constexpr double fades = 60.0;  // to 1/e [s]

}  // namespace

double ComputedTime::lately(double now) const { return lately_ * std::exp((at_ - now) / fades); }

void ComputedTime::add(double seconds, double now) {
  lately_ = lately(now) + seconds;
  at_ = now;
  in_all_ += seconds;
}

bool Turns::take(const ComputedTime& computed, double now, const std::stop_token& off) {
  std::unique_lock lock(mutex_);
  const auto mine = waiting_.emplace(now + computed.lately(now), came_++).first;
  const bool got = changed_.wait(lock, off, [&] { return !taken_ && waiting_.begin() == mine; });
  waiting_.erase(mine);
  if (got)
    taken_ = true;
  else
    changed_.notify_all();
  return got;
}

void Turns::give_back() {
  const std::lock_guard lock(mutex_);
  taken_ = false;
  changed_.notify_all();
}

}  // namespace asdic::detail::serve
