#include "raytrace/cases/earth_line.h"

#include <cmath>

namespace asdic::detail {

EarthLine::EarthLine(const PropagationCase& run_case) {
  if (!run_case.on_map) return;
  earth_ = EarthPlaces(run_case.origin, run_case.on_area ? run_case.on_area->area.get() : nullptr);
  place_ = Vec2(run_case.on_map->x, run_case.on_map->y);
  bearing_ = run_case.on_map->bearing + run_case.off_transect;
}

Vec2 EarthLine::on_map(double range) const noexcept {
  return place_ + range * Vec2(std::sin(bearing_), std::cos(bearing_));
}

GeographicPlace EarthLine::at(double range) const noexcept {
  const Vec2 place = on_map(range);
  return earth_.at(place.x(), place.y());
}

}  // namespace asdic::detail
