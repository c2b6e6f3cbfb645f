#pragma once
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail::bellhop_emulation {

/// A boundary as BELLHOP keeps it: straight segments through its nodes, made flat out to infinity
/// on both sides. Unit vectors (range, depth); normals point out of the water.
class BoundaryLine {
 public:
  /// \param unit_normals  make the means of a curvilinear boundary unit vectors
  BoundaryLine(const Boundary& boundary, BoundaryKind kind, bool unit_normals = false);

  /// What reflects at a point of a segment. On a curvilinear boundary tangent and normal are means
  /// of the nodes' and not quite of unit length.
  struct Facet {
    Vec2 tangent, normal;
    double curvature = 0.0;  ///< dslope/dr·cos³ [1/m]
  };

  /// Moves `segment` to the one over x; on a node, to the side to which `direction` points.
  void locate(double range, double direction, std::size_t& segment) const noexcept;
  [[nodiscard]] double left(std::size_t segment) const noexcept { return range_[segment]; }
  [[nodiscard]] double right(std::size_t segment) const noexcept { return range_[segment + 1]; }
  [[nodiscard]] Vec2 node(std::size_t segment) const noexcept {
    return {range_[segment], depth_[segment]};
  }
  [[nodiscard]] const Vec2& normal(std::size_t segment) const noexcept { return normal_[segment]; }
  [[nodiscard]] bool is_flat(std::size_t segment) const noexcept {
    return depth_[segment] == depth_[segment + 1];
  }
  /// How far outside the water a point is; negative inside [m].
  [[nodiscard]] double outside(const Vec2& x, std::size_t segment) const noexcept {
    return (x - anchor(segment)).dot(normal_[segment]);
  }
  [[nodiscard]] Facet facet(const Vec2& x, std::size_t segment) const noexcept;
  [[nodiscard]] const BoundaryMaterial& material(std::size_t segment) const noexcept {
    return material_[segment];
  }

 private:
  /// A point of the segment at a finite range.
  [[nodiscard]] Vec2 anchor(std::size_t segment) const noexcept {
    return node(segment == 0 ? 1 : segment);
  }

  BoundaryKind kind_;
  bool curvilinear_ = false, unit_normals_ = false;
  std::vector<double> range_, depth_;       // [n + 2] with the far ends
  std::vector<Vec2> tangent_, normal_;      // [n + 1] of the segments
  std::vector<Vec2> node_tangent_;          // [n + 2], plain means
  std::vector<double> curvature_;           // [n + 1]
  std::vector<BoundaryMaterial> material_;  // [n + 1]
};

}  // namespace asdic::detail::bellhop_emulation
