#include "processing/delay_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sonar/paths/enough_bounces.h"

namespace asdic::detail {
namespace {

constexpr std::size_t most_tables = 512;

}  // namespace

double DelayTables::longest(double delay, double apart) noexcept {
  return std::exp2(std::ceil(2.0 * std::log2(0.5 * 1600.0 * delay + apart + 1.0)) / 2.0);
}

/// With as many bounces as there is sound in at any of the ranges, or as many as are asked for.
DelayTable DelayTables::made(const Plane& plane, double platform_depth, double depth,
                             double longest) {
  constexpr std::size_t segments = 32;  // of range
  std::vector<double> ranges(ranges_);
  for (std::size_t i = 0; i < ranges_; ++i)
    ranges[i] = longest * static_cast<double>(i + 1) / static_cast<double>(ranges_);
  const auto solver = paths_.solver(plane);
  const auto find = [&](const PathLimits& limits) {
    return solver->find(platform_depth, depth, ranges, frequency_, limits);
  };
  if (in_numbers(settings_)) return {ranges, find(limits_of(settings_)), limits_of(settings_)};
  // Over rough ground paths multiply with every bounce; a place is told by few of them.
  constexpr std::size_t told_apart = 16, none_too_many = std::numeric_limits<std::size_t>::max();
  const bool map = paths_.area() != nullptr;
  std::vector<Arrivals> found;
  Bounces enough =
      search_bounces(settings_,
                     {.first = map ? fewest_bounces + 1 : 2 * fewest_bounces,
                      .growth = map ? 1.5 : 2.0,
                      .most = 2 * most_bounces,
                      .most_paths = map ? told_apart * ranges_ : none_too_many,
                      .segments = segments,
                      .latest = longest},
                     [&](const PathLimits& limits, ReceivedBounces& received) {
                       found = find(limits);
                       for (std::size_t i = 0; i < ranges_; ++i)
                         for (const Arrival& path : found[i])
                           received.add(ranges[i], path.surface_bounces, path.bottom_bounces,
                                        std::norm(path.amplitude) + path.scattered);
                     });
  if (std::max(enough.surface, enough.bottom) > most_bounces) lack_bounces_ = true;
  enough.surface = std::min(enough.surface, most_bounces);
  enough.bottom = std::min(enough.bottom, most_bounces);
  return {ranges, found, limits_of(settings_, enough)};
}

std::shared_ptr<const DelayTable> DelayTables::from(const Vec3& platform, double bearing,
                                                    double depth, double longest) {
  // Over a map every bearing has a plane of its own: those of a sector share that of its middle.
  constexpr double sectors = 144.0, width = 2.0 * pi / sectors;
  if (paths_.area()) bearing = (std::floor(bearing / width) + 0.5) * width;
  const Plane plane = paths_.plane(platform, bearing, longest);
  // In a layered ocean all planes are one. Places that move by less than a metre share a table.
  const bool layered = paths_.layered();
  Key key(0.0, 1.0, 0.0, platform.z(), depth, longest);
  auto& [first, second, third, own_depth, target_depth, furthest] = key;
  if (paths_.area())
    first = std::round(plane.place.x()), second = plane.bearing,
    third = std::round(plane.place.y());
  else if (!layered)
    first = std::round(plane.origin), second = plane.cos_beta;
  {
    const std::scoped_lock lock(lock_);
    if (const auto known = made_.find(key); known != made_.end()) return known->second;
  }
  auto table = std::make_shared<const DelayTable>(made(plane, platform.z(), depth, longest));
  const std::scoped_lock lock(lock_);
  if (made_.size() >= most_tables) made_.clear();
  return made_.emplace(key, std::move(table)).first->second;
}

}  // namespace asdic::detail
