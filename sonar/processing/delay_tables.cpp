#include "sonar/processing/delay_tables.h"

#include <cmath>
#include <utility>
#include <vector>

namespace asdic {
namespace {

constexpr std::size_t most_tables = 256;

}  // namespace

double DelayTables::longest(double delay, double apart) noexcept {
  return std::exp2(std::ceil(2.0 * std::log2(0.5 * 1600.0 * delay + apart + 1.0)) / 2.0);
}

std::shared_ptr<const DelayTable> DelayTables::from(const Vec3& platform, double bearing,
                                                    double depth, double longest) {
  const Plane plane = paths_.plane(platform, bearing);
  // In a layered ocean all planes are one. Places that move by less than a metre share a table.
  const bool layered = paths_.layered();
  const Key key(layered ? 0.0 : std::round(plane.origin), layered ? 1.0 : plane.cos_beta,
                platform.z(), depth, longest);
  {
    const std::scoped_lock lock(lock_);
    if (const auto known = made_.find(key); known != made_.end()) return known->second;
  }
  std::vector<double> ranges(ranges_);
  for (std::size_t i = 0; i < ranges_; ++i)
    ranges[i] = longest * static_cast<double>(i + 1) / static_cast<double>(ranges_);
  auto made = std::make_shared<const DelayTable>(*paths_.solver(plane), platform.z(), depth, ranges,
                                                 frequency_, limits_);
  const std::scoped_lock lock(lock_);
  if (made_.size() >= most_tables) made_.clear();
  return made_.emplace(key, std::move(made)).first->second;
}

}  // namespace asdic
