#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "raytrace/area/map_axis.h"

namespace asdic::detail {

/// Values on a grid of two axes, at one or more levels, that may be far too many to hold: square
/// tiles are read when one of their values is first asked for, and kept. Shared by threads; what
/// comes out does not depend on what was read before.
class MapGrid {
 public:
  /// A rectangle of columns (along the first axis) and rows.
  struct Window {
    std::size_t column = 0, row = 0, columns = 0, rows = 0;
  };
  /// Fills values [rows × columns × levels] of a window, NaN where there is none. Called by one
  /// thread of a grid at a time.
  using Reader = std::function<void(const Window&, std::span<float> values)>;

  MapGrid(MapAxis x, MapAxis y, std::size_t levels, Reader reader);

  [[nodiscard]] const MapAxis& x() const noexcept { return x_; }
  [[nodiscard]] const MapAxis& y() const noexcept { return y_; }
  [[nodiscard]] std::size_t levels() const noexcept { return levels_; }
  /// Of a column and a row: [levels]. Valid as long as the grid.
  [[nodiscard]] const float* at(std::size_t column, std::size_t row) const {
    const std::size_t tile = (row / side_) * tiles_across_ + column / side_;
    const float* values = tiles_[tile].load(std::memory_order_acquire);
    if (values == nullptr) values = read_tile(tile);
    const std::size_t width = std::min(side_, x_.size() - column / side_ * side_);
    return values + ((row % side_) * width + column % side_) * levels_;
  }

  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }  ///< read so far

 private:
  const float* read_tile(std::size_t tile) const;

  MapAxis x_, y_;
  std::size_t levels_, side_, tiles_across_;
  Reader reader_;
  mutable std::mutex lock_;
  mutable std::vector<std::atomic<const float*>> tiles_;
  mutable std::vector<std::unique_ptr<float[]>> kept_;
  mutable std::atomic<std::size_t> bytes_{0};
};

}  // namespace asdic::detail
