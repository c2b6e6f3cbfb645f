#pragma once
#include "core/units.h"

namespace asdic::detail {

/// A place on the Earth [°].
struct GeographicPlace {
  double latitude = 0.0;   ///< north
  double longitude = 0.0;  ///< east

  [[nodiscard]] bool operator==(const GeographicPlace&) const = default;
};

/// How a scenario's map lies over the grids that fill it. x east, y north [m] of the map's [0, 0].
///
/// Geographic grids have longitudes and latitudes. The map is the azimuthal equidistant projection
/// about its [0, 0]: distance from there and bearing there are true. Over a distance d the map
/// stretches what lies across by (d/R)/sin(d/R): 0.004 % at 100 km, 0.1 % at 500 km. The Earth is a
/// sphere of 6371 km. Snyder, Map Projections: A Working Manual (1987), ch. 25. Other grids are
/// projected already, with axes in m; the map is the same shifted.
class MapFrame {
 public:
  /// \param origin  of the map
  [[nodiscard]] static MapFrame geographic(const GeographicPlace& origin);
  /// \param easting, northing  of the map's [0, 0] on the grids' axes [m]
  [[nodiscard]] static MapFrame projected(double easting, double northing);

  static constexpr double earth_radius = 6.371e6;  ///< [m]

  /// Where a place of the map is on the axes of a grid ([°] or [m]), and how that changes.
  struct OnGrid {
    double u = 0.0, v = 0.0;  ///< longitude, latitude; or easting, northing
    double u_x = 1.0, u_y = 0.0, v_x = 0.0, v_y = 1.0;
  };
  [[nodiscard]] OnGrid on_grid(double x, double y) const noexcept;
  /// Of a place of a grid, on the map [m].
  [[nodiscard]] Vec2 on_map(double u, double v) const noexcept;

  [[nodiscard]] bool is_geographic() const noexcept { return geographic_; }
  [[nodiscard]] const GeographicPlace& origin() const noexcept { return origin_; }
  /// How long a step along the grid's axes is on the map, there [m].
  [[nodiscard]] Vec2 metres_per_unit(double x, double y) const noexcept;

  [[nodiscard]] bool operator==(const MapFrame&) const = default;

 private:
  bool geographic_ = false;
  GeographicPlace origin_;
  double easting_ = 0.0, northing_ = 0.0;
  double sine_ = 0.0, cosine_ = 1.0;  // of the origin's latitude
};

}  // namespace asdic::detail
