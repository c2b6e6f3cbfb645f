#include "raytrace/area/ocean_on_map.h"

#include <cmath>

#include "raytrace/ocean/slice.h"

namespace asdic::detail {

Environment along_transect(const Area& area, const Transect& transect) {
  constexpr double far = 100e3;
  const Vec2 place(transect.x, transect.y);
  return area.section(place, transect.bearing, area.reach_on_map(place, transect.bearing, far));
}

bool OceanOnMap::varies() const noexcept { return area != nullptr || varies_with_range(along); }

double OceanOnMap::surface_depth(const Vec3& place) const {
  if (area != nullptr) return area->surface_depth();
  return along.surface.depth_at(transect.range_of(place.x(), place.y()));
}

double OceanOnMap::bottom_depth(const Vec3& place) const {
  if (area != nullptr) return area->bottom_depth(place.x(), place.y());
  return along.bottom.depth_at(transect.range_of(place.x(), place.y()));
}

double OceanOnMap::speed_at(const Vec3& place) const {
  if (area != nullptr) return area->speed_at(place.x(), place.y(), place.z()).c;
  return sound_speed(along, transect.range_of(place.x(), place.y()), place.z()).c;
}

Environment OceanOnMap::plane(const Vec2& place, double bearing, double reach) const {
  if (area != nullptr) return area->section(place, bearing, reach);
  return slice(along, transect.range_of(place.x(), place.y()),
               std::cos(bearing - transect.bearing));
}

}  // namespace asdic::detail
