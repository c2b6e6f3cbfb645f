#include "processing/delay_table.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace asdic::detail {

PathHistory history_of(const Arrival& path) noexcept {
  return {.surface_bounces = path.surface_bounces,
          .bottom_bounces = path.bottom_bounces,
          .upper_turns = path.upper_turns,
          .lower_turns = path.lower_turns,
          .caustics = path.caustics,
          .upwards = path.launch_elevation >= 0.0};
}

DelayTable::DelayTable(const EigenraySolver& solver, double platform_depth, double depth,
                       std::span<const double> ranges, double frequency, const PathLimits& limits)
    : DelayTable(ranges, solver.find(platform_depth, depth, ranges, frequency, limits), limits) {}

DelayTable::DelayTable(std::span<const double> ranges, std::span<const Arrivals> found,
                       const PathLimits& limits)
    : ranges_(ranges.begin(), ranges.end()),
      step_(ranges.size() > 1 ? ranges[1] - ranges[0] : 1.0) {
  std::map<PathHistory, std::vector<Node>> nodes;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    for (const Arrival& path : found[i]) {
      if (path.surface_bounces > limits.max_surface_bounces ||
          path.bottom_bounces > limits.max_bottom_bounces)
        continue;
      auto& branch = nodes[history_of(path)];
      if (!branch.empty() && branch.back().range == ranges[i]) continue;  // the sooner of two
      branch.push_back({.range = ranges[i],
                        .delay = path.delay,
                        .slope = path.horizontal_slowness,
                        .elevation = path.launch_elevation,
                        .amplitude = std::abs(path.amplitude),
                        .place = i});
    }
  for (auto& [history, list] : nodes) branches_.push_back({history, std::move(list)});
}

std::optional<DelayTable::Node> DelayTable::at(const Branch& branch, double range) const noexcept {
  const auto& nodes = branch.nodes;
  const auto after = std::lower_bound(nodes.begin(), nodes.end(), range,
                                      [](const Node& node, double r) { return node.range < r; });
  if (after == nodes.end()) return std::nullopt;
  if (after->range == range) return *after;
  if (after == nodes.begin()) return std::nullopt;
  const Node &a = *(after - 1), &b = *after;
  const double h = b.range - a.range;
  if (h > 1.5 * step_) return std::nullopt;  // a gap
  const double t = (range - a.range) / h;
  // Hermite's cubic: both ends and their slopes.
  const double t2 = t * t, t3 = t2 * t;
  const auto blend = [&](double from, double to) { return from + t * (to - from); };
  return Node{.range = range,
              .delay = (2.0 * t3 - 3.0 * t2 + 1.0) * a.delay + (t3 - 2.0 * t2 + t) * h * a.slope +
                       (3.0 * t2 - 2.0 * t3) * b.delay + (t3 - t2) * h * b.slope,
              .slope = blend(a.slope, b.slope),
              .elevation = blend(a.elevation, b.elevation),
              .amplitude = blend(a.amplitude, b.amplitude)};
}

}  // namespace asdic::detail
