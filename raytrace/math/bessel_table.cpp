#include "raytrace/math/bessel_table.h"

#include <cmath>
#include <mutex>
#include <utility>

namespace asdic::detail {

BesselTable::BesselTable(double furthest) {
  // The function is the same for all: the longest table so far serves all that ask for less.
  static std::mutex mutex;
  static std::shared_ptr<const Cubics> longest = std::make_shared<Cubics>();
  const std::lock_guard lock(mutex);
  const auto count = static_cast<std::size_t>(furthest * steps) + 2;
  if (longest->size() < count) {
    Cubics longer = *longest;
    const auto value = [](std::size_t i) { return ::j0(static_cast<double>(i) / steps); };
    const auto slope = [](std::size_t i) { return -::j1(static_cast<double>(i) / steps) / steps; };
    // POSIX' Bessel functions: std's are slow
    for (std::size_t i = longer.size(); i < count; ++i) {
      const double from = slope(i), to = slope(i + 1), rise = value(i + 1) - value(i);
      longer.push_back({value(i), from, 3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise});
    }
    longest = std::make_shared<Cubics>(std::move(longer));
  }
  cubics_ = longest;
}

}  // namespace asdic::detail
