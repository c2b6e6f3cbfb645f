#pragma once
#include <optional>

#include "raytrace/area/area.h"
#include "raytrace/area/map_frame.h"
#include "raytrace/ocean/ocean_origin.h"

namespace asdic::detail {

/// Where places of a scenario's map are on the Earth: all latitudes and longitudes of results come
/// from here. They are known where the map's [0, 0] is (environment.origin), unless the map has the
/// axes of a projected grid: those may be turned against the meridian, and the grid does not say by
/// how much.
class EarthPlaces {
 public:
  EarthPlaces() = default;  ///< nothing is known
  /// \param area  the ocean over the map; none: the transect's
  EarthPlaces(const std::optional<OceanOrigin>& origin, const Area* area);

  [[nodiscard]] bool known() const noexcept { return frame_.has_value(); }
  /// Of a place of the map [m]. Longitudes run on: past 180 where the map's [0, 0] is below.
  /// \return NaN of a place that is NaN, and where nothing is known
  [[nodiscard]] GeographicPlace at(double x, double y) const noexcept;

 private:
  std::optional<MapFrame> frame_;
};

}  // namespace asdic::detail
