#pragma once
#include "raytrace/area/area.h"
#include "raytrace/ocean/transect.h"

namespace asdic::detail {

/// Of a plane that is followed as far as anybody asks for: an area's is taken out so far [m].
inline constexpr double reach_of_area = 500e3;

/// An ocean and how it lies on the map: along a transect, across which it is uniform, or over an
/// area. The parts outlive it.
struct OceanOnMap {
  const Environment& along;  ///< of the transect; of an area: its section there
  const Transect& transect;
  const Area* area = nullptr;  ///< none: the transect is all

  /// Whether water or boundaries vary from place to place.
  [[nodiscard]] bool varies() const noexcept;
  /// Depths of surface and bottom, and speed of sound, at a place [m], [m], [m/s].
  [[nodiscard]] double surface_depth(const Vec3& place) const;
  [[nodiscard]] double bottom_depth(const Vec3& place) const;
  [[nodiscard]] double speed_at(const Vec3& place) const;
  /// The vertical plane from a place along a bearing [rad], to at least `reach` m: range 0 is the
  /// place.
  [[nodiscard]] Environment plane(const Vec2& place, double bearing, double reach) const;
};

/// The section of an area that stands for it where one plane is all: from the transect's place on
/// the map along its bearing, to 100 km or the end of the map.
[[nodiscard]] Environment along_transect(const Area& area, const Transect& transect);

}  // namespace asdic::detail
