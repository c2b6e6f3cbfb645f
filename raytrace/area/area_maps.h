#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/area/map_frame.h"
#include "raytrace/area/map_grid.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

/// A function of the map at a place, with its derivatives along x (east) and y (north).
struct MapValue {
  double value = 0.0;
  double x = 0.0, y = 0.0;              ///< first derivatives [1/m]
  double xx = 0.0, xy = 0.0, yy = 0.0;  ///< second derivatives [1/m²]
};

/// Sound speed at a place of the sea, with its derivatives.
struct SoundSpeed3D {
  double c = 0.0;                                                                 ///< [m/s]
  double c_x = 0.0, c_y = 0.0, c_z = 0.0;                                         ///< [1/s]
  double c_xx = 0.0, c_xy = 0.0, c_xz = 0.0, c_yy = 0.0, c_yz = 0.0, c_zz = 0.0;  ///< [1/(m·s)]
};

/// Where the values of a map come from, for messages: "place.nc: elevation".
struct MapOrigin {
  std::string name;
  [[nodiscard]] bool operator==(const MapOrigin&) const = default;
};

/// How a map runs between its grid's places.
enum class MapInterpolation {
  bicubic,  ///< MapAxis's cubic along both axes: value and slope are continuous
  faceted,  ///< two triangles a cell, divided from its first corner to that across: slopes jump
};

/// A number over the map: depth of the sea floor, wind.
class ScalarMap {
 public:
  /// \param sign  of the values against those of the grid: −1 makes depths of heights
  /// \param more  than the grid's: the sea's height over the datum of depths
  ScalarMap(std::shared_ptr<const MapGrid> grid, MapFrame frame, MapInterpolation interpolation,
            double sign, MapOrigin origin, double more = 0.0);

  /// \throws InputError where the map has a hole, by its place
  [[nodiscard]] MapValue at(double x, double y) const;
  /// A bound: nowhere in a box of the map is the value less. −∞ where there is a hole, or where
  /// the box is too wide to be looked at.
  [[nodiscard]] double least_within(const Vec2& low, const Vec2& high) const;
  /// Which triangle of a faceted map a place is on.
  [[nodiscard]] std::size_t facet(double x, double y) const noexcept;
  /// Whether a place is on the map: elsewhere its edge goes on.
  [[nodiscard]] bool covers(double x, double y) const noexcept;
  /// The shorter step of the grid there [m].
  [[nodiscard]] double spacing(double x, double y) const noexcept;

  [[nodiscard]] const MapGrid& grid() const noexcept { return *grid_; }
  [[nodiscard]] const MapFrame& frame() const noexcept { return frame_; }
  [[nodiscard]] MapInterpolation interpolation() const noexcept { return interpolation_; }
  [[nodiscard]] const std::string& name() const noexcept { return origin_.name; }

 private:
  [[nodiscard]] MapValue bicubic(const MapFrame::OnGrid& place) const;
  [[nodiscard]] MapValue faceted(const MapFrame::OnGrid& place) const;
  [[nodiscard]] double least_of_cubics(const MapGrid::Window& nodes) const;
  void check(double value, double u, double v) const;

  std::shared_ptr<const MapGrid> grid_;
  MapFrame frame_;
  MapInterpolation interpolation_;
  double sign_, more_;
  MapOrigin origin_;
};

/// Speed of sound over map and depth: MapAxis's cubic along all three axes, so that speed and
/// gradient are continuous. Beyond the outer columns it goes on level, above and below the levels
/// straight on.
class WaterMap {
 public:
  /// \param depths  [levels ≥ 2] increasing [m]
  WaterMap(std::shared_ptr<const MapGrid> grid, MapFrame frame, std::vector<double> depths,
           MapOrigin origin);

  /// \throws InputError where a column is missing
  [[nodiscard]] SoundSpeed3D at(double x, double y, double z) const;
  /// Speeds of one place [depths.size()].
  [[nodiscard]] std::vector<double> column(double x, double y,
                                           std::span<const double> depths) const;
  [[nodiscard]] bool covers(double x, double y) const noexcept;
  [[nodiscard]] double spacing(double x, double y) const noexcept;
  [[nodiscard]] const MapAxis& depths() const noexcept { return depths_; }
  [[nodiscard]] const std::string& name() const noexcept { return origin_.name; }
  /// As few depths as it takes for straight lines between them to leave the cubics of the columns
  /// at some places by at most `error` [m/s]. \param top  the first of them, if the levels begin
  /// below
  [[nodiscard]] std::vector<double> straight_levels(std::span<const Vec2> places, double top,
                                                    double error) const;

 private:
  std::shared_ptr<const MapGrid> grid_;
  MapFrame frame_;
  MapAxis depths_;
  MapOrigin origin_;
};

/// Numbers of kinds of sea floor, or of anything else that has no values between: those of the
/// nearest place.
class ClassMap {
 public:
  ClassMap(std::shared_ptr<const MapGrid> grid, MapFrame frame, MapOrigin origin);

  /// Of the nearest cell; where it has none, of the nearest of those around it.
  /// \throws InputError where there is none
  [[nodiscard]] int at(double x, double y) const;
  [[nodiscard]] bool covers(double x, double y) const noexcept;
  [[nodiscard]] double spacing(double x, double y) const noexcept;
  [[nodiscard]] const std::string& name() const noexcept { return origin_.name; }

 private:
  std::shared_ptr<const MapGrid> grid_;
  MapFrame frame_;
  MapOrigin origin_;
};

}  // namespace asdic::detail
