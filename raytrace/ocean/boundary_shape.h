#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

/// How a boundary runs between its nodes.
enum class ShapeInterpolation {
  piecewise_linear,  ///< straight facets: the tangent jumps at a node
  smooth,  ///< a cubic through the nodes with continuous slope, at a node that of the line between
           ///< its neighbours: position, tangent and curvature are those of one curve
  curvilinear,  ///< of BELLHOP's files: straight facets for the position; the tangent turns
                ///< linearly from node to node, unit length, and the curvature is that with which
                ///< it turns
};

[[nodiscard]] std::string_view name(ShapeInterpolation interpolation) noexcept;

/// A point of a boundary. The tangent points to greater range; unit vectors as (range, depth).
struct BoundaryPoint {
  double depth = 0.0;      ///< [m]
  double slope = 0.0;      ///< d(depth)/d(range) of the tangent that reflects
  double curvature = 0.0;  ///< dφ/ds along the boundary, φ = atan(slope), s arc length [1/m]
};

/// Where a sea floor or a sea surface is that is not flat: depth as a function of range, beyond the
/// first and last node flat at their depths. Depth and range in m, depth positive down for both
/// boundaries, ranges may be negative.
class BoundaryShape {
 public:
  /// \param range  [n] strictly increasing, n ≥ 1   \param depth  [n]
  /// \param material  empty, or [n]: what lies behind the facet from node i to node i + 1 (the
  /// last:
  ///                  beyond the last node; before the first node: material[0])
  /// \throws InputError naming the first value at fault ("range[3]", "depth[0]", "material")
  BoundaryShape(std::span<const double> range, std::span<const double> depth,
                ShapeInterpolation interpolation, std::vector<BoundaryMaterial> material = {});

  /// A smooth boundary whose slopes at its nodes are known.
  /// \param slope  [n] d(depth)/d(range)
  [[nodiscard]] static BoundaryShape with_slopes(std::span<const double> range,
                                                 std::span<const double> depth,
                                                 std::span<const double> slope,
                                                 std::vector<BoundaryMaterial> material = {});

  /// The same boundary along a line that leaves the transect at `origin` [m] under an angle of this
  /// cosine: a point at range r of the line lies at origin + r·cosine of the transect. Depths stay,
  /// slopes shrink by the cosine. \param cosine  −1..1, not 0; below 0 the line runs backwards
  [[nodiscard]] BoundaryShape along(double origin, double cosine) const;

  [[nodiscard]] std::span<const double> ranges() const noexcept { return range_; }
  [[nodiscard]] std::span<const double> depths() const noexcept { return depth_; }
  [[nodiscard]] ShapeInterpolation interpolation() const noexcept { return interpolation_; }
  /// Empty when one material serves everywhere (Boundary::material).
  [[nodiscard]] std::span<const BoundaryMaterial> materials() const noexcept { return material_; }

  /// Facet 0 is the flat part before the first node, facet i runs from node i − 1 to node i,
  /// facet n goes on flat after the last. A node belongs to the facet after it.
  [[nodiscard]] std::size_t facets() const noexcept { return range_.size() + 1; }
  [[nodiscard]] std::size_t facet(double range) const noexcept;
  /// Where a facet begins and ends; ∓infinity for the outer ones.
  [[nodiscard]] double facet_begin(std::size_t facet) const noexcept;
  [[nodiscard]] double facet_end(std::size_t facet) const noexcept;
  /// Depth of the boundary by the law of one facet, whether the range lies on it or not [m].
  [[nodiscard]] double depth_at(double range, std::size_t facet) const noexcept;
  /// Depth, reflecting tangent and curvature by the law of one facet.
  [[nodiscard]] BoundaryPoint at(double range, std::size_t facet) const noexcept;
  [[nodiscard]] double depth_at(double range) const noexcept {
    return depth_at(range, facet(range));
  }
  [[nodiscard]] BoundaryPoint at(double range) const noexcept { return at(range, facet(range)); }

  /// Least and greatest depth reached anywhere [m].
  [[nodiscard]] double shallowest() const noexcept { return shallowest_; }
  [[nodiscard]] double deepest() const noexcept { return deepest_; }

  [[nodiscard]] bool operator==(const BoundaryShape&) const = default;

 private:
  void bend_facets();  // tangent_, out of the nodes
  void find_extremes();

  std::vector<double> range_, depth_;       // [n]
  std::vector<double> slope_;               // [n] at the nodes (smooth)
  std::vector<Vec2> tangent_;               // [n] at the nodes, about unit length (curvilinear)
  std::vector<BoundaryMaterial> material_;  // [n] or empty
  ShapeInterpolation interpolation_;
  double shallowest_ = 0.0, deepest_ = 0.0;
};

}  // namespace asdic::detail
