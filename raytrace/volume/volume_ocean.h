#pragma once
#include <array>
#include <cstddef>

#include "core/units.h"
#include "raytrace/ocean/boundary.h"
#include "raytrace/ocean/depth_function.h"
#include "raytrace/ocean/roughness.h"

namespace asdic::detail {

using Mat2 = SmallMatrix<2, 2>;
using Mat3 = SmallMatrix<3, 3>;

/// Speed of sound at a place, with its derivatives over (x, y, z).
struct VolumeSpeed {
  double c = 1500.0;             ///< [m/s]
  Vec3 gradient = Vec3::Zero();  ///< [1/s]
  Mat3 hessian = Mat3::Zero();   ///< [1/(m·s)]
};

/// The sea floor z = D(x, y) at a place, with the derivatives of D over (x, y).
struct VolumeFloor {
  double depth = 0.0;            ///< D [m]
  Vec2 gradient = Vec2::Zero();  ///< of D
  Mat2 hessian = Mat2::Zero();   ///< [1/m]; of a facet 0
  std::size_t facet = 0;         ///< whose number it is, where the slope jumps between facets
};

/// Between two parallel planes: low ≤ normal·x ≤ high.
struct WaterSlab {
  Vec3 normal = Vec3::UnitZ();  ///< unit length
  double low = -infinity, high = infinity;
};

/// A part of the water in which the speed is one smooth law. At its walls the gradient may jump,
/// the speed does not.
struct WaterCell {
  std::size_t index = 0;             ///< what speed() takes
  bool uniform = false;              ///< one speed all over the cell: rays are straight there
  std::array<WaterSlab, 2> slabs{};  ///< its walls
  std::size_t walls = 0;             ///< how many slabs count
};

/// An ocean in three dimensions, as rays see it: x east, y north, z down [m] on the local map. The
/// sea surface is flat. Immutable while anything is traced through it; shared by threads.
class VolumeOcean {
 public:
  VolumeOcean() = default;
  VolumeOcean(const VolumeOcean&) = delete;
  VolumeOcean& operator=(const VolumeOcean&) = delete;
  virtual ~VolumeOcean() = default;

  /// The cell that a ray is in which leaves a place in a direction: at a wall the cell beyond it.
  /// By default all water is one cell.
  [[nodiscard]] virtual WaterCell water_cell(const Vec3& place, const Vec3& towards) const;
  /// By the law of a cell, whether the place lies in it or a little beyond.
  [[nodiscard]] virtual VolumeSpeed speed(const Vec3& place, std::size_t cell) const = 0;
  /// The same where no cell is known.
  [[nodiscard]] VolumeSpeed speed_at(const Vec3& place) const;
  /// A bound of |∇c|/c² along the horizon [s/m²]; 0: the speed depends on depth alone.
  [[nodiscard]] virtual double sideways_bending() const { return 0.0; }

  [[nodiscard]] virtual double surface_depth() const { return 0.0; }
  [[nodiscard]] virtual const BoundaryMaterial& surface_material() const;
  [[nodiscard]] virtual const Roughness& surface_roughness() const;

  [[nodiscard]] virtual VolumeFloor floor(double x, double y) const = 0;
  /// What lies behind the floor there.
  [[nodiscard]] virtual const BoundaryMaterial& floor_material(double x, double y) const = 0;
  [[nodiscard]] virtual const Roughness& floor_roughness() const;
  /// The floor does not bend twice within this distance along the horizon [m]: the spacing of its
  /// grid, the width of its facets. Infinite: a plane.
  [[nodiscard]] virtual double floor_spacing() const = 0;
  [[nodiscard]] virtual double shallowest_floor() const = 0;  ///< a bound [m]; −∞ where unknown
  [[nodiscard]] virtual double deepest_floor() const = 0;     ///< a bound [m]; +∞ where unknown
  [[nodiscard]] virtual double steepest_floor() const = 0;    ///< a bound of |∇D|
  /// No floor within a box of the map is shallower [m]: what is above it meets none there.
  [[nodiscard]] virtual double shallowest_within(const Vec2& low, const Vec2& high) const;
  /// The deepest floor that is known of, where there is no bound [m].
  [[nodiscard]] virtual double deepest_known() const { return deepest_floor(); }

  [[nodiscard]] virtual double water_density(double depth) const;
  /// All that the water takes out of a wave [Np/m] over depth. \param frequency [Hz]
  [[nodiscard]] virtual DepthFunction attenuation(double frequency) const;
};

}  // namespace asdic::detail
