#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "raytrace/area/area.h"

namespace asdic::detail::support {

/// A grid of a function on even axes, and how many values of it were read.
struct MapOf {
  std::shared_ptr<std::size_t> read = std::make_shared<std::size_t>(0);
  std::shared_ptr<const MapGrid> grid;

  /// \param value  of x, y and the level's index
  MapOf(double begin, double end, std::size_t n, std::size_t levels,
        std::function<double(double, double, std::size_t)> value) {
    std::vector<double> places;
    for (std::size_t i = 0; i < n; ++i)
      places.push_back(std::lerp(begin, end, double(i) / double(n - 1)));
    grid = std::make_shared<const MapGrid>(
        MapAxis("x", places), MapAxis("y", places), levels,
        [count = read, places, levels, value = std::move(value)](const MapGrid::Window& window,
                                                                 std::span<float> values) {
          std::size_t next = 0;
          for (std::size_t j = 0; j < window.rows; ++j)
            for (std::size_t i = 0; i < window.columns; ++i)
              for (std::size_t k = 0; k < levels; ++k)
                values[next++] =
                    static_cast<float>(value(places[window.column + i], places[window.row + j], k));
          *count += values.size();
        });
  }
};

/// Depths of a function, `step` apart to `reach` m about the map's [0, 0].
inline ScalarMap floor_of(double reach, double step, std::function<double(double, double)> depth,
                          MapInterpolation interpolation = MapInterpolation::bicubic) {
  const auto n = static_cast<std::size_t>(2.0 * reach / step) + 1;
  const MapOf map(-reach, reach, n, 1, [depth = std::move(depth)](double x, double y, std::size_t) {
    return depth(x, y);
  });
  return {map.grid, MapFrame::projected(0.0, 0.0), interpolation, 1.0, {"test: depth"}};
}

}  // namespace asdic::detail::support
