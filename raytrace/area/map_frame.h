#pragma once
#include "core/units.h"

namespace asdic::detail {

/// A place on the Earth [°], on the ellipsoid of WGS 84.
struct GeographicPlace {
  double latitude = 0.0;   ///< north
  double longitude = 0.0;  ///< east

  [[nodiscard]] bool operator==(const GeographicPlace&) const = default;
};

/// How a scenario's map lies over the grids that fill it. x east, y north [m] of the map's [0, 0].
///
/// Geographic grids have longitudes and latitudes of WGS 84. The ellipsoid is mapped on the sphere
/// that lies closest to it at the map's [0, 0], conformally (Gauss), and that by the azimuthal
/// equidistant projection about [0, 0] on the map. So distances and bearings from there are those
/// of geodesics, to 10⁻⁶ at 100 km. Over a distance d the map stretches what lies across by
/// (d/R)/sin(d/R): 0.004 % at 100 km, 0.1 % at 500 km. Snyder, Map Projections: A Working Manual
/// (1987), ch. 3 and 25. Other grids are projected already, with axes in m; the map is the same
/// shifted.
class MapFrame {
 public:
  /// \param origin  of the map
  [[nodiscard]] static MapFrame geographic(const GeographicPlace& origin);
  /// \param easting, northing  of the map's [0, 0] on the grids' axes [m]
  [[nodiscard]] static MapFrame projected(double easting, double northing);

  static constexpr double earth_radius = 6.371e6;  ///< the mean, where that will do [m]

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
  // Gauss' sphere: its radius; isometric latitude there = stretch·isometric latitude + shift,
  // longitude from the origin there = stretch·longitude from the origin.
  double radius_ = earth_radius, stretch_ = 1.0, shift_ = 0.0;
  double sine_ = 0.0, cosine_ = 1.0;  // of the origin's latitude on the sphere
};

}  // namespace asdic::detail
