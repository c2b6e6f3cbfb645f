#include "raytrace/volume/floor_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace asdic::detail {
namespace {

constexpr double cells_of_block = 2.0;   // of the map, along a side
constexpr double least_table = 200e3;    // is what all blocks cover at least, along a side [m]
constexpr std::size_t blocks = 1024;     // along a side of the table
constexpr std::size_t most_at_once = 8;  // along a side of a box

}  // namespace

FloorBlocks::FloorBlocks(const ScalarMap& map, double land)
    : map_(map),
      land_(land),
      side_(std::max(cells_of_block * map.spacing(0.0, 0.0), least_table / blocks)),
      kept_(blocks * blocks) {
  for (std::atomic<float>& one : kept_)
    one.store(std::numeric_limits<float>::quiet_NaN(), std::memory_order_relaxed);
}

double FloorBlocks::shallowest(const Vec2& low, const Vec2& high) const {
  constexpr double half = 0.5 * blocks;
  const double i0 = std::floor(low.x() / side_) + half, i1 = std::floor(high.x() / side_) + half,
               j0 = std::floor(low.y() / side_) + half, j1 = std::floor(high.y() / side_) + half;
  if (!(i0 >= 0.0 && j0 >= 0.0 && i1 < double(blocks) && j1 < double(blocks))) return -infinity;
  if (i1 - i0 >= double(most_at_once) || j1 - j0 >= double(most_at_once)) return -infinity;
  float least = std::numeric_limits<float>::infinity();
  for (auto j = std::size_t(j0); j <= std::size_t(j1); ++j)
    for (auto i = std::size_t(i0); i <= std::size_t(i1); ++i) {
      float here = kept_[j * blocks + i].load(std::memory_order_relaxed);
      if (std::isnan(here)) {
        here = measured(i, j);
        kept_[j * blocks + i].store(here, std::memory_order_relaxed);
      }
      least = std::min(least, here);
    }
  return double(least);
}

float FloorBlocks::measured(std::size_t column, std::size_t row) const {
  const Vec2 low((double(column) - 0.5 * blocks) * side_, (double(row) - 0.5 * blocks) * side_);
  const double found = map_.least_within(low, Vec2(low.x() + side_, low.y() + side_));
  constexpr float none = -std::numeric_limits<float>::infinity();
  if (std::isinf(found)) return none;  // a hole, which is told where a ray gets there
  return std::nextafter(float(std::max(land_, found)), none);
}

}  // namespace asdic::detail
