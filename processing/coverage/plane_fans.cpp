#include "processing/coverage/plane_fans.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "raytrace/parallel/parallel.h"

namespace asdic::detail {

PlaneFans::PlaneFans(const PropagationPaths& paths, const Vec3& place,
                     std::vector<WantedLevel> levels, double spacing, double reach,
                     double frequency)
    : paths_(paths),
      fans_(paths),
      place_(place),
      levels_(std::move(levels)),
      spacing_(spacing),
      reach_(reach),
      frequency_(frequency) {
  if (!paths_.layered()) return;
  for (const WantedLevel& wanted : levels_)
    everywhere_.push_back(fans_.around(place_, wanted.level,
                                       {.sectors = 1,
                                        .spacing = spacing_,
                                        .wide = spacing_,
                                        .max_range = reach_,
                                        .frequency = frequency_,
                                        .limits = wanted.limits}));
}

/// The planes of one direction. [levels]
std::vector<FanPlane> PlaneFans::planes(double bearing) const {
  // One fan for all levels, with the most bounces that any of them asks for.
  PathLimits limits = levels_.front().limits;
  std::vector<GroundLevel> levels;
  for (const WantedLevel& wanted : levels_) {
    levels.push_back(wanted.level);
    limits.max_surface_bounces =
        std::max(limits.max_surface_bounces, wanted.limits.max_surface_bounces);
    limits.max_bottom_bounces =
        std::max(limits.max_bottom_bounces, wanted.limits.max_bottom_bounces);
  }
  const Plane plane = paths_.plane(place_, bearing, reach_);
  std::vector<BoundaryPaths> all = mean_paths(*paths_.solver(plane), place_.z(), levels, spacing_,
                                              reach_, frequency_, limits, rays);
  std::vector<FanPlane> found;
  for (std::size_t i = 0; i < all.size(); ++i)
    found.push_back(fans_.plane_of(place_, plane, levels[i],
                                   std::make_shared<const BoundaryPaths>(std::move(all[i]))));
  return found;
}

PlaneFans::Fans PlaneFans::at(double bearing) const {
  if (paths_.layered() || levels_.empty()) return everywhere_;
  Fans found;
  for (FanPlane& plane : planes(bearing)) {
    auto fan = std::make_shared<BoundaryFan>();
    fan->planes.push_back(std::move(plane));
    found.push_back(std::move(fan));
  }
  return found;
}

PlaneFans::Fans PlaneFans::all_round(int sectors, const std::function<void(double)>& tell) const {
  if (paths_.layered() || levels_.empty()) return everywhere_;
  const auto count = static_cast<std::size_t>(sectors);
  std::vector<std::vector<FanPlane>> all(count);
  std::atomic<int> done = 0;
  in_parallel(count, [&](std::size_t i) {
    all[i] = planes(2.0 * pi * (static_cast<double>(i) + 0.5) / sectors);
    tell(static_cast<double>(++done) / sectors);
  });
  Fans found;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    auto fan = std::make_shared<BoundaryFan>();
    fan->sectors = sectors;
    fan->mirrored = false;
    for (std::vector<FanPlane>& planes : all) fan->planes.push_back(std::move(planes[level]));
    found.push_back(std::move(fan));
  }
  return found;
}

}  // namespace asdic::detail
