#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "raytrace/layered/column.h"
#include "raytrace/layered/path_builder.h"
#include "raytrace/layered/ray_at_range.h"
#include "raytrace/layered/simd_rays.h"

namespace asdic::detail {

/// RayFan where the speed is linear in depth between samples and the boundaries are flat: a ray is
/// its Snell invariant, and after one cycle it repeats itself. So each layer is summed once,
/// several at a time, whole half cycles are counted, and the ray is found in its last layer.
/// docs/theory/layered-rays.md
class LayeredFan {
 public:
  /// Empty if the ocean is not of this kind, or the source not within the water.
  static std::optional<LayeredFan> make(const Environment& environment, double frequency,
                                        double source_depth);

  /// Memory of one thread: [nodes] and [layers], padded to lanes.
  struct Workspace {
    std::vector<double> sine, reach, d_range, time;
  };

  /// \return false: a ray almost vertical, level or backwards is one for the RayTracer
  bool trace(double elevation, double range, Workspace& work, RayAtRange& out) const noexcept;

 private:
  LayeredFan(const Environment& environment, double frequency,
             std::shared_ptr<const Column> column);

  /// From the top vertex down to a node, one way: what `trace` counts half cycles of.
  struct Sum {
    double range = 0.0, d_range = 0.0, time = 0.0;
  };
  void sum_layers(double xi, double sigma, Workspace& work) const noexcept;
  [[nodiscard]] Sum turn(double xi, double sine, double gradient) const noexcept;

  std::shared_ptr<const Column> column_;
  PathBuilder builder_;
  std::size_t source_node_, layers_;
  std::vector<double> depth_, speed_;                     // [nodes]
  std::vector<double> upper_, lower_, gradient_, sum_h_;  // [layers] c, c, g, (c_a + c_b)h
};

}  // namespace asdic::detail
