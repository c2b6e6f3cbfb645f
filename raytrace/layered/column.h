#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "raytrace/layered/layer.h"
#include "raytrace/layered/layer_pass.h"
#include "raytrace/layered/ray_parameter.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Horizontal distances of one ray in a column with two depths of interest: from the upper of them
/// to the ray's top vertex (where it turns or meets the surface), between the two, and from the
/// lower one to its bottom vertex.
struct ColumnSums {
  Pass up, middle, down;
  bool turns_above = false;  ///< the top vertex is a turning point, not the surface
  bool turns_below = false;
};

/// The same for time and length, of the roots only.
struct ColumnDetails {
  PassDetail up, middle, down;
};

/// The water of a layered ocean, cut at the depths of a source and a receiver. Every ray between
/// them is made of the three pieces of ColumnSums.
class Column {
 public:
  Column(std::span<const Layer> water, double source_depth, double receiver_depth);

  [[nodiscard]] ColumnSums sums(const RayParameter& ray) const noexcept;
  [[nodiscard]] ColumnDetails details(const RayParameter& ray) const noexcept;
  /// Both in one walk.
  struct All {
    ColumnSums sums;
    ColumnDetails details;
  };
  [[nodiscard]] All all(const RayParameter& ray) const noexcept;

  /// Of the layers whose tops are the upper and the lower of the two depths; the latter may be
  /// layers().size().
  [[nodiscard]] std::size_t upper() const noexcept { return upper_; }
  [[nodiscard]] std::size_t lower() const noexcept { return lower_; }

  [[nodiscard]] bool source_is_upper() const noexcept { return source_is_upper_; }
  [[nodiscard]] double source_speed() const noexcept { return source_speed_; }
  [[nodiscard]] double receiver_speed() const noexcept { return receiver_speed_; }
  [[nodiscard]] double surface_speed() const noexcept { return layers_.front().c_top; }
  [[nodiscard]] double bottom_speed() const noexcept { return layers_.back().c_bottom; }
  [[nodiscard]] const std::vector<Layer>& layers() const noexcept { return layers_; }

  /// The fastest speed between source and receiver: only rays that turn at faster water join them
  /// [m/s].
  [[nodiscard]] double barrier_speed() const noexcept;
  /// The depth of the water over the fastest speed at the layers' ends [s].
  [[nodiscard]] double least_crossing_time() const noexcept;

 private:
  std::vector<Layer> layers_;
  std::size_t upper_ = 0, lower_ = 0;  // layers_[upper_].top and layers_[lower_].top are the two
                                       // depths (lower_ may be layers_.size())
  bool source_is_upper_;
  double source_speed_ = 0.0, receiver_speed_ = 0.0;
};

}  // namespace asdic::detail
