#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytrace/area/area_maps.h"

namespace asdic::detail {

/// A map in a file: which variable of which.
struct MapFile {
  std::string file, variable;

  [[nodiscard]] bool operator==(const MapFile&) const = default;
};

/// What a number of a map of the sea floor stands for.
struct SeabedClass {
  int number = 0;
  std::string name;
  BoundaryMaterial material = FluidHalfSpace{};

  [[nodiscard]] bool operator==(const SeabedClass&) const = default;
};

/// Where an area is read from.
struct AreaSettings {
  std::optional<GeographicPlace> origin;  ///< of the map's [0, 0], for geographic grids
  double easting = 0.0, northing = 0.0;   ///< of the map's [0, 0], for projected grids [m]
  MapFile bathymetry;
  MapInterpolation interpolation = MapInterpolation::bicubic;
  double water_level = 0.0;  ///< of the sea over the datum of depths [m]
  std::optional<MapFile> sound_speed, seabed, wind;
  std::vector<SeabedClass> classes;

  [[nodiscard]] bool operator==(const AreaSettings&) const = default;
};

}  // namespace asdic::detail
