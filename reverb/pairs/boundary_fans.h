#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/memory_budget.h"
#include "raytrace/paths/boundary_paths.h"
#include "raytrace/places/propagation_paths.h"

namespace asdic::detail {

/// How a cell of a boundary that is not level, or not everywhere alike, answers, against the same
/// cell seen in the plane of the rays alone.
struct CellFacet {
  double grazing = 1.0;  ///< sin of the angle to the surface over sin of the angle to its line in
                         ///< the plane (BoundaryPath::grazing): √(1 + h′²cos²β)/√(1 + h′²)
  double area = 1.0;  ///< of the sloping facet over its horizontal projection: √(1 + h′²)
  int kind = 0;       ///< of an area's floor: its number; of a surface under mapped wind: wind_kind
};

/// A surface under a map of wind scatters by the law of its wind, in steps of half a metre per
/// second. \param wind_speed [m/s]
[[nodiscard]] inline int wind_kind(double wind_speed) noexcept {
  return static_cast<int>(std::lround(2.0 * wind_speed));
}
[[nodiscard]] inline double wind_of_kind(int kind) noexcept { return 0.5 * kind; }

/// What is asked of a path's ends again and again.
struct PathEnds {
  double launch_level = 0.0;  ///< horizontal slowness at the launch, cos(elevation)/c [s/m]
  double launch_down = 0.0;   ///< vertical slowness there, positive down [s/m]
  double sine = 0.0;          ///< of the grazing angle
  double cosine = 1.0;        ///< of it
  double down = 0.0;          ///< vertical slowness at the boundary, positive down [s/m]
};

/// The paths to a boundary in one vertical plane.
struct FanPlane {
  std::shared_ptr<const BoundaryPaths> paths;
  std::vector<PathEnds> ends;     ///< [paths->all()]
  std::vector<CellFacet> facets;  ///< [cells], empty where the boundary is level
};

/// The paths to a boundary all round a place. One plane serves all bearings of a layered ocean.
/// Elsewhere the plane of a bearing is that of the middle of its sector; sector 0 begins at the
/// transect's bearing. Over a transect every two sectors mirrored about it share a plane.
struct BoundaryFan {
  std::vector<FanPlane> planes;
  double first_bearing = 0.0;  ///< [rad]
  int sectors = 1;
  bool mirrored = true;        ///< over a transect
  std::uint64_t identity = 0;  ///< for keys of what is worked out of it: no other fan's

  [[nodiscard]] const FanPlane& towards(double bearing) const noexcept;
};

/// Where the fans of places meet boundaries.
///
/// Planes are traced when first asked for and kept, in the memory of the paths, for a place that
/// stays (in a layered ocean: that keeps its depth). Shared by threads; what comes out does not
/// depend on what is kept.
class BoundaryFans {
 public:
  struct Settings {
    int sectors = 36;        ///< planes all round, where the ocean varies
    double spacing = 50.0;   ///< of the grid along a plane [m]
    double wide = 0.0;       ///< of its cells further out, in layered water; at least the spacing
    double max_range = 1e5;  ///< [m]
    double frequency = 1000.0;  ///< [Hz]
    PathLimits limits;
    bool means = false;  ///< over an area: few rays, right as means over cells (mean_paths())
  };

  /// Of cells as wide as that, none is wider than this share of its range.
  static constexpr double widest_of_range = 1.0 / 16.0;

  /// What around() takes of memory for a place whose paths are not known yet: two of each bounce in
  /// every cell, at most.
  [[nodiscard]] MemoryNeed need(const Settings& settings) const;
  /// \param paths  must outlive this
  explicit BoundaryFans(const PropagationPaths& paths) : paths_(paths) {}

  /// \param known  is told whether they had been traced
  [[nodiscard]] std::shared_ptr<const BoundaryFan> around(const Vec3& place,
                                                          const GroundLevel& level,
                                                          const Settings& settings,
                                                          bool* known = nullptr) const;

  /// A plane through a place, of paths that were found in it by themselves.
  [[nodiscard]] FanPlane plane_of(const Vec3& place, const Plane& plane, const GroundLevel& level,
                                  std::shared_ptr<const BoundaryPaths> paths) const;

 private:
  struct Entry;
  [[nodiscard]] std::vector<CellFacet> facets_of(const Plane& plane, const GroundLevel& level,
                                                 const Environment& ocean,
                                                 const BoundaryPaths& paths) const;
  [[nodiscard]] BoundaryFan trace(const Vec3& place, const GroundLevel& level,
                                  const Settings& settings, const StopPoint& stop) const;

  const PropagationPaths& paths_;
};

}  // namespace asdic::detail
