#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "core/propagation_memory.h"
#include "raytrace/area/ocean_on_map.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/places/reuse.h"
#include "raytrace/volume/volume_ocean.h"

namespace asdic::detail {

/// A vertical plane through the ocean: from a place on the map in one direction. Over a transect
/// the first two say all, over an area the others.
struct Plane {
  double origin = 0.0;        ///< of the place along the transect [m]
  double cos_beta = 1.0;      ///< of the angle between the direction and the transect
  Vec2 place = Vec2::Zero();  ///< [m]
  double bearing = 0.0;       ///< clockwise from north [rad]
  double reach = 0.0;         ///< at least, of the section that is taken out of the area [m]
};

/// The sound paths between any two places of a scenario's map.
///
/// In a layered ocean one solver serves all places. Where the ocean varies along a transect or over
/// an area, sound travels in the vertical plane through both places (N × 2D), and each plane is a
/// slice of the ocean with a solver of its own. Where a volume is given, eigenrays are searched in
/// it. The slices and eigenrays that were used last are kept. Shared by threads; what comes out
/// does not depend on what is kept. docs/theory/transect.md, docs/theory/area.md
class PropagationPaths {
 public:
  /// \param area  none: the ocean along the transect is all   \param memory  of what was found;
  /// none: one of its own, which forgets what 64 pings did not use   \param volume  the same ocean
  /// in three dimensions: eigenrays are those of the volume then, unless the ocean is layered,
  /// where both are the same
  PropagationPaths(const Environment& ocean, const Transect& transect,
                   std::shared_ptr<const Area> area = nullptr,
                   std::shared_ptr<PropagationMemory> memory = nullptr,
                   std::shared_ptr<const VolumeOcean> volume = nullptr);
  PropagationPaths(const PropagationPaths&) = delete;
  PropagationPaths& operator=(const PropagationPaths&) = delete;

  /// Of the ocean as it is given: from the transect's origin along it.
  [[nodiscard]] const EigenraySolver& along_transect() const noexcept { return along_; }
  [[nodiscard]] bool layered() const noexcept { return layered_; }
  [[nodiscard]] const Transect& transect() const noexcept { return transect_; }
  /// Null if there is none.
  [[nodiscard]] const std::shared_ptr<const Area>& area() const noexcept { return area_; }
  [[nodiscard]] OceanOnMap on_map() const noexcept {
    return {along_.environment(), transect_, area_.get()};
  }

  [[nodiscard]] PropagationMemory& memory() const noexcept { return *memory_; }
  /// A key of this ocean, to which is added what else a result depends on.
  template <class... Values>
  [[nodiscard]] ExactKey key(Kept kind, const Values&... values) const {
    return ExactKey(kind, identity_, values...);
  }

  /// The plane through a place in a direction [rad, clockwise from north]. \param reach  how far
  /// sound is followed in it [m]
  [[nodiscard]] Plane plane(const Vec3& from, double bearing, double reach) const noexcept;
  /// The solver of a plane, source at range 0: one for all planes of a layered ocean.
  [[nodiscard]] std::shared_ptr<const EigenraySolver> solver(const Plane& plane) const;

  /// Of growing range, clockwise from north [rad].
  [[nodiscard]] double transect_bearing() const noexcept { return transect_.bearing; }
  /// How far along the transect a place is [m].
  [[nodiscard]] double along(const Vec3& place) const noexcept {
    return transect_.range_of(place.x(), place.y());
  }
  /// Depth of surface and bottom at a place [m].
  [[nodiscard]] double surface_depth(const Vec3& place) const;
  [[nodiscard]] double bottom_depth(const Vec3& place) const;
  /// Speed of sound at a place [m/s].
  [[nodiscard]] double speed_at(const Vec3& place) const;

  /// The volume that eigenrays go through; null: they keep to vertical planes.
  [[nodiscard]] const VolumeOcean* volume() const noexcept {
    return layered_ ? nullptr : volume_.get();
  }

  /// Those of the vertical plane through both places, in three dimensions, too: what is to be known
  /// beforehand, how many bounces there are for instance, is asked of it.
  [[nodiscard]] Arrivals find_in_plane(const Vec3& from, const Vec3& to, double frequency,
                                       const PathLimits& limits) const;
  /// All eigenrays from one place to another, sorted by delay. \param reuse  counts what was known
  [[nodiscard]] Arrivals find(const Vec3& from, const Vec3& to, double frequency,
                              const PathLimits& limits, Reuse* reuse = nullptr) const;
  /// The same paths after the places have moved by metres, each followed from what it was, sorted
  /// by delay; all of them searched anew, no wider than they ask for, if one cannot be. \param
  /// paths  between two places nearby
  [[nodiscard]] Arrivals follow(std::span<const Arrival> paths, const Vec3& from, const Vec3& to,
                                double frequency, const PathLimits& limits,
                                Reuse* reuse = nullptr) const;

 private:
  [[nodiscard]] Plane plane(const Vec3& from, const Vec3& to) const noexcept;
  [[nodiscard]] Environment environment_of(const Plane& plane) const;
  [[nodiscard]] Arrivals search_plane(const Vec3& from, const Vec3& to, double frequency,
                                      const PathLimits& limits) const;
  [[nodiscard]] Arrivals search(const Vec3& from, const Vec3& to, double frequency,
                                const PathLimits& limits) const;
  /// The solver of a layered ocean, and that of the same ocean without roughness.
  [[nodiscard]] std::shared_ptr<const EigenraySolver> layered_solver() const;
  [[nodiscard]] std::shared_ptr<const EigenraySolver> between_mirrors() const;
  /// Returns the paths after ensure_bounded() has checked them; rays alone in layered oceans are
  /// not checked.
  [[nodiscard]] Arrivals bounded(Arrivals found, const Vec3& from, const Vec3& to, double frequency,
                                 const PathLimits& limits) const;
  [[nodiscard]] ExactKey leg_key(Kept kind, const Vec3& from, const Vec3& to, double frequency,
                                 const PathLimits& limits) const;
  /// Returns the leg of find() without copying it. \param known  is set to whether it had been kept
  [[nodiscard]] std::shared_ptr<const Arrivals> leg(const Vec3& from, const Vec3& to,
                                                    double frequency, const PathLimits& limits,
                                                    bool* known = nullptr) const;
  [[nodiscard]] Arrivals followed(std::span<const Arrival> known, const Vec3& from, const Vec3& to,
                                  double frequency, const PathLimits& limits) const;

  EigenraySolver along_;
  Transect transect_;
  std::shared_ptr<const Area> area_;
  bool layered_;
  std::uint64_t identity_;  // of this ocean in a memory that several share
  std::shared_ptr<PropagationMemory> memory_;
  std::shared_ptr<const VolumeOcean> volume_;
};

void add_to(ExactKey& key, const PathLimits& limits);
/// Adds what tells a plane from others of its ocean. \param area  whether that is one
void add_to(ExactKey& key, const Plane& plane, bool area);
/// Adds all that a path is followed by to a key: its angle and history.
void add_path(ExactKey& key, const Arrival& path);

}  // namespace asdic::detail
