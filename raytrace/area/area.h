#pragma once
#include <map>
#include <optional>
#include <string>

#include "raytrace/area/area_maps.h"
#include "raytrace/area/area_settings.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/ocean/transect.h"

namespace asdic::detail {

/// An ocean over a map: depth, water and sea floor by maps of their own, the rest of an Environment
/// everywhere the same, or along a transect. Immutable but for what it reads as it is asked. Shared
/// by threads. docs/theory/area.md
class Area {
 public:
  static constexpr double film = 0.1;  ///< of water over land [m]

  struct Maps {
    ScalarMap floor;                      ///< depths [m], at most 0 on land
    std::optional<WaterMap> water = {};   ///< none: Environment::water everywhere
    std::optional<ClassMap> seabed = {};  ///< none: Environment::bottom's material everywhere
    std::map<int, BoundaryMaterial> materials = {};  ///< of the seabed's numbers
    std::optional<ScalarMap> wind = {};              ///< at 10 m [m/s]; none: one everywhere
  };
  /// \param everywhere  surface, losses, roughness, and water where there is no map of it
  /// \param settings  where it was read   \param transect  along which `everywhere` varies
  Area(Maps maps, Environment everywhere, AreaSettings settings = {}, Transect transect = {});

  [[nodiscard]] const ScalarMap& floor() const noexcept { return maps_.floor; }
  [[nodiscard]] const std::optional<WaterMap>& water() const noexcept { return maps_.water; }
  [[nodiscard]] const std::optional<ClassMap>& seabed() const noexcept { return maps_.seabed; }
  [[nodiscard]] const std::optional<ScalarMap>& wind() const noexcept { return maps_.wind; }
  [[nodiscard]] const AreaSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const Environment& everywhere() const noexcept { return everywhere_; }
  [[nodiscard]] const Transect& transect() const noexcept { return transect_; }
  [[nodiscard]] const MapFrame& frame() const noexcept { return maps_.floor.frame(); }

  /// Depth of the sea floor [m], at most 0 on land.
  [[nodiscard]] double bottom_depth(double x, double y) const { return maps_.floor.at(x, y).value; }
  /// Whether there is no more than the film of water that land has.
  [[nodiscard]] bool is_land(double x, double y) const {
    return bottom_depth(x, y) <= surface_depth() + film;
  }
  [[nodiscard]] double surface_depth() const noexcept { return everywhere_.surface.depth; }
  [[nodiscard]] SoundSpeed3D speed_at(double x, double y, double z) const;
  [[nodiscard]] const BoundaryMaterial& material_at(double x, double y) const;

  /// The vertical plane from a place along a bearing [rad], to `reach` m and a little behind: nodes
  /// of the floor where the map needs them, as Hermite cubics that leave a bicubic map by a few
  /// centimetres and a faceted one not at all; profiles at the spacing of the water's grid. Land is
  /// a film of water of 0.1 m over a floor that reflects nothing, so that sound that runs up a
  /// coast ends there.
  [[nodiscard]] Environment section(const Vec2& place, double bearing, double reach) const;

  /// The same with what the scattering laws of its rough boundaries take elsewhere.
  [[nodiscard]] Area scattering(ScatteredElsewhere surface, ScatteredElsewhere bottom) const;

  /// How far floor and water go on from a place along a bearing, to `most` m [m].
  [[nodiscard]] double reach_on_map(const Vec2& place, double bearing, double most) const;
  /// The nearest end of any of the maps, within `most` m of a place; `most` itself: there is none.
  struct Edge {
    double distance = 0.0, bearing = 0.0;  ///< [m], [rad]
    std::string map = {};                  ///< its name
  };
  [[nodiscard]] Edge nearest_edge(const Vec2& place, double most) const;
  /// Which map has ended before a place, so that its edge is what is there.
  enum class End : int { none, floor, water, other };
  [[nodiscard]] End end_at(double x, double y) const noexcept;
  /// Of the floor's grid at a place [m].
  [[nodiscard]] double spacing(const Vec2& place) const noexcept {
    return maps_.floor.spacing(place.x(), place.y());
  }
  /// Shallowest and deepest floor and fastest water within a distance of a place, on the grids'
  /// own spacing or a coarser one of 200 lines.
  struct Bounds {
    double shallowest = 0.0, deepest = 0.0, fastest = 0.0;
  };
  /// Least and most wind within a distance of a place [m/s].
  struct Winds {
    double least = 0.0, most = 0.0;
  };
  [[nodiscard]] Winds winds(const Vec2& place, double distance) const;
  [[nodiscard]] Bounds bounds(const Vec2& place, double distance) const;

 private:
  [[nodiscard]] Boundary floor_along(const Vec2& place, double bearing, double reach) const;
  void put_waves(const Vec2& place, double bearing, double reach, Environment& plane) const;
  void put_water(const Vec2& place, double bearing, double reach, Environment& plane) const;

  Maps maps_;
  AreaSettings settings_;
  Environment everywhere_;
  Transect transect_;
};

}  // namespace asdic::detail
