#include "raytrace/area/map_grid.h"

#include <algorithm>
#include <utility>

namespace asdic::detail {
namespace {

/// Of a tile: so that reading one takes about a millisecond.
std::size_t side_of_tiles(std::size_t levels) { return levels == 1 ? 128 : 16; }

std::size_t tiles_along(const MapAxis& axis, std::size_t side) {
  return (axis.size() + side - 1) / side;
}

}  // namespace

MapGrid::MapGrid(MapAxis x, MapAxis y, std::size_t levels, Reader reader)
    : x_(std::move(x)),
      y_(std::move(y)),
      levels_(levels),
      side_(side_of_tiles(levels)),
      tiles_across_(tiles_along(x_, side_)),
      reader_(std::move(reader)),
      tiles_(tiles_across_ * tiles_along(y_, side_)) {}

const float* MapGrid::read_tile(std::size_t tile) const {
  const std::scoped_lock lock(lock_);
  if (const float* values = tiles_[tile].load(std::memory_order_relaxed)) return values;
  Window window{.column = tile % tiles_across_ * side_, .row = tile / tiles_across_ * side_};
  window.columns = std::min(side_, x_.size() - window.column);
  window.rows = std::min(side_, y_.size() - window.row);
  const std::size_t count = window.rows * window.columns * levels_;
  auto values = std::make_unique<float[]>(count);
  reader_(window, {values.get(), count});
  bytes_ += count * sizeof(float);
  const float* made = kept_.emplace_back(std::move(values)).get();
  tiles_[tile].store(made, std::memory_order_release);
  return made;
}

}  // namespace asdic::detail
