#include "raytrace/area/earth_places.h"

#include <cmath>
#include <limits>

#include "core/units.h"

namespace asdic::detail {

EarthPlaces::EarthPlaces(const std::optional<OceanOrigin>& origin, const Area* area) {
  if (origin && (area == nullptr || area->frame().is_geographic()))
    frame_ = MapFrame::geographic({degrees(origin->latitude), degrees(origin->longitude)});
}

GeographicPlace EarthPlaces::at(double x, double y) const noexcept {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!frame_ || !std::isfinite(x) || !std::isfinite(y)) return {none, none};
  const MapFrame::OnGrid place = frame_->on_grid(x, y);
  return {.latitude = place.v, .longitude = place.u};
}

}  // namespace asdic::detail
