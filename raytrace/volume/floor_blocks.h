#pragma once
#include <atomic>
#include <cstddef>
#include <vector>

#include "raytrace/area/area_maps.h"

namespace asdic::detail {

/// Blocks of a map of depths, each with the shallowest floor in it, measured when one is first
/// asked for: what is above it needs no look at the floor. Shared by threads.
class FloorBlocks {
 public:
  /// \param map  outlives this   \param land  the floor is nowhere shallower [m]
  FloorBlocks(const ScalarMap& map, double land);

  /// A bound within a box of the map [m]; −∞ far from the map's [0, 0] and of wide boxes.
  [[nodiscard]] double shallowest(const Vec2& low, const Vec2& high) const;

 private:
  [[nodiscard]] float measured(std::size_t column, std::size_t row) const;

  const ScalarMap& map_;
  double land_, side_;
  mutable std::vector<std::atomic<float>> kept_;  // NaN: not looked at
};

}  // namespace asdic::detail
