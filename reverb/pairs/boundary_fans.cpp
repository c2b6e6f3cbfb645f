#include "reverb/pairs/boundary_fans.h"

#include <tbb/collaborative_call_once.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

/// How each cell's facet lies. A slope h′ along the transect is h′·cos β in the plane: the angle to
/// the facet is that to its line in the plane, corrected for the part of its normal that sticks out
/// of the plane.
std::vector<CellFacet> facets_over_transect(const Boundary& boundary, double cos_beta,
                                            const BoundaryPaths& paths) {
  std::vector<CellFacet> facets;
  if (!boundary.shape || cos_beta == 0.0) return facets;
  for (std::size_t cell = 0; cell < paths.cells(); ++cell) {
    const double in_plane = boundary.shape->at(paths.range(cell)).slope;
    const double segment = std::hypot(1.0, in_plane / cos_beta);  // √(1 + h′²)
    facets.push_back({.grazing = std::hypot(1.0, in_plane) / segment, .area = segment});
  }
  return facets;
}

/// The same of an area's floor, whose slope is (h_x, h_y): in the plane h_x sin B + h_y cos B.
std::vector<CellFacet> facets_over_area(const Area& area, const Plane& plane,
                                        const BoundaryPaths& paths) {
  std::vector<CellFacet> facets;
  const Vec2 way(std::sin(plane.bearing), std::cos(plane.bearing));
  for (std::size_t cell = 0; cell < paths.cells(); ++cell) {
    const Vec2 there = plane.place + paths.range(cell) * way;
    const MapValue floor = area.floor().at(there.x(), there.y());
    const double in_plane = floor.x * way.x() + floor.y * way.y();
    const double area_ratio = std::sqrt(1.0 + floor.x * floor.x + floor.y * floor.y);
    facets.push_back({.grazing = std::hypot(1.0, in_plane) / area_ratio,
                      .area = area_ratio,
                      .kind = area.seabed() && !area.is_land(there.x(), there.y())
                                  ? area.seabed()->at(there.x(), there.y())
                                  : 0});
  }
  return facets;
}

/// Of the flat surface of an area: what wind there is. Empty without a map of it.
std::vector<CellFacet> winds_over_area(const Area& area, const Plane& plane,
                                       const BoundaryPaths& paths) {
  std::vector<CellFacet> facets;
  if (!area.wind()) return facets;
  const Vec2 way(std::sin(plane.bearing), std::cos(plane.bearing));
  for (std::size_t cell = 0; cell < paths.cells(); ++cell) {
    const Vec2 there = plane.place + paths.range(cell) * way;
    facets.push_back({.kind = wind_kind(area.wind()->at(there.x(), there.y()).value)});
  }
  return facets;
}

/// \param speed  of sound at the fan's source [m/s]
std::vector<PathEnds> ends_of(const BoundaryPaths& paths, double speed) {
  std::vector<PathEnds> ends;
  ends.reserve(paths.size());
  for (const BoundaryPath& p : paths.all()) {
    const double sine = std::sin(p.grazing), cosine = std::cos(p.grazing);
    ends.push_back({.launch_level = std::cos(p.launch_elevation) / speed,
                    .launch_down = -std::sin(p.launch_elevation) / speed,
                    .sine = sine,
                    .cosine = cosine,
                    .down = p.downward * p.horizontal_slowness * sine / cosine});
  }
  return ends;
}

std::size_t bytes_of(const BoundaryFan& fan) {
  std::size_t bytes = sizeof(BoundaryFan);
  for (const FanPlane& plane : fan.planes)
    bytes += sizeof(FanPlane) + plane.paths->bytes() + plane.paths->size() * sizeof(PathEnds) +
             plane.facets.size() * sizeof(CellFacet);
  return bytes;
}

GroundGrid grid_of(const BoundaryFans::Settings& settings) {
  return {settings.spacing, std::max(settings.wide, settings.spacing),
          settings.wide / BoundaryFans::widest_of_range};
}

/// Of a fan over an area, and more where strong paths part: within 0.1 dB of one that tells every
/// path, and a fifth of its cost.
constexpr int rays_over_area = 256;

std::uint64_t next_identity() {
  static std::atomic<std::uint64_t> next{0};
  return next++;
}

}  // namespace

const FanPlane& BoundaryFan::towards(double bearing) const noexcept {
  if (planes.size() == 1) return planes.front();
  const double turns = (bearing - first_bearing) / (2.0 * pi);
  const int sector = std::min(sectors - 1, static_cast<int>((turns - std::floor(turns)) * sectors));
  return planes[static_cast<std::size_t>(mirrored ? std::min(sector, sectors - 1 - sector)
                                                  : sector)];
}

struct BoundaryFans::Entry {
  tbb::collaborative_once_flag traced;  // who waits for the planes helps to trace them
  BoundaryFan fan;
};

std::shared_ptr<const BoundaryFan> BoundaryFans::around(const Vec3& place, const GroundLevel& level,
                                                        const Settings& settings,
                                                        bool* known) const {
  const bool layered = paths_.layered();
  const PathLimits& limits = settings.limits;
  ExactKey key = paths_.key(Kept::boundary_fan);
  key.add(level.boundary ? static_cast<int>(*level.boundary) : -1).add(level.depth);
  if (!layered)
    add_to(key, paths_.plane(place, paths_.transect_bearing(), 0.0), paths_.area() != nullptr);
  key.add(place.z()).add(settings.frequency);
  key.add(settings.spacing)
      .add(settings.wide)
      .add(settings.max_range)
      .add(layered ? 0 : settings.sectors)
      .add(settings.means);
  key.add(limits.max_surface_bounces).add(limits.max_bottom_bounces).add(limits.max_launch_angle);
  key.add(limits.max_vertices).add(limits.faintest);
  key.add(limits.max_delay).add(limits.home_slowness);
  PropagationMemory& memory = paths_.memory();
  const auto entry = memory.remember(
      key, [] { return std::make_shared<Entry>(); }, [](const Entry&) { return sizeof(Entry); },
      known);
  const StopPoint stop;
  tbb::collaborative_call_once(entry->traced, [&] {
    entry->fan = trace(place, level, settings, stop);
    entry->fan.identity = next_identity();
    memory.charge(key, bytes_of(entry->fan));
  });
  return {entry, &entry->fan};
}

MemoryNeed BoundaryFans::need(const Settings& settings) const {
  // As they are found and as they are kept; then their ends.
  constexpr double a_path = 2.0 * sizeof(BoundaryPath) + sizeof(PathEnds);
  const PathLimits& limits = settings.limits;
  const int bounces = std::max(limits.max_surface_bounces, limits.max_bottom_bounces);
  const double planes = paths_.layered() ? 1.0
                        : paths_.area()  ? settings.sectors
                                         : 0.5 * (settings.sectors + 1),
               cells = planes * static_cast<double>(grid_of(settings).count(settings.max_range)),
               paths = 2.0 * (paths_.layered() ? followed_cycles(bounces) : bounces + 1.0) * cells;
  return {.where = "reverberation.ground_spacing",
          .what = "paths of up to " + std::to_string(bounces) + " bounces to " +
                  std::to_string(std::llround(cells)) + " cells of the ground",
          .bytes = paths * a_path,
          .remedy =
              "a larger spacing, fewer bounces (propagation.max_surface_bounces, "
              "max_bottom_bounces) or a shorter record"};
}

/// How the cells of a level of a plane answer.
std::vector<CellFacet> BoundaryFans::facets_of(const Plane& plane, const GroundLevel& level,
                                               const Environment& ocean,
                                               const BoundaryPaths& paths) const {
  if (!level.boundary) return {};
  const bool surface = *level.boundary == BoundaryKind::surface;
  if (!paths_.area())
    return facets_over_transect(surface ? ocean.surface : ocean.bottom, plane.cos_beta, paths);
  return (surface ? winds_over_area : facets_over_area)(*paths_.area(), plane, paths);
}

FanPlane BoundaryFans::plane_of(const Vec3& place, const Plane& plane, const GroundLevel& level,
                                std::shared_ptr<const BoundaryPaths> paths) const {
  FanPlane made{.paths = std::move(paths), .ends = {}, .facets = {}};
  made.ends = ends_of(*made.paths, paths_.speed_at(place));
  if (!paths_.layered())
    made.facets = facets_of(plane, level, paths_.solver(plane)->environment(), *made.paths);
  return made;
}

BoundaryFan BoundaryFans::trace(const Vec3& place, const GroundLevel& level,
                                const Settings& settings, const StopPoint& stop) const {
  const auto height = [&](const Environment& ocean) {
    const double depth = !level.boundary                            ? level.depth
                         : *level.boundary == BoundaryKind::surface ? ocean.surface.depth
                                                                    : ocean.bottom.depth;
    return std::abs(depth - place.z());
  };
  const auto ground = [&](const EigenraySolver& solver) {
    const GroundGrid grid = grid_of(settings).fine_below(height(solver.environment()));
    if (settings.means && !solver.layered()) {
      const std::array levels{level};
      return std::make_shared<const BoundaryPaths>(
          std::move(mean_paths(solver, place.z(), levels, grid.without_fine(), settings.max_range,
                               settings.frequency, settings.limits, rays_over_area)
                        .front()));
    }
    return std::make_shared<const BoundaryPaths>(
        boundary_paths(solver, place.z(), level, grid, settings.max_range, settings.frequency,
                       settings.limits, stop));
  };
  const double speed = paths_.speed_at(place);
  if (paths_.layered()) {
    const auto paths = ground(paths_.along_transect());
    return {.planes = {{.paths = paths, .ends = ends_of(*paths, speed), .facets = {}}}};
  }
  const int n = settings.sectors;
  const bool mirrored = paths_.area() == nullptr;
  BoundaryFan fan{
      .planes = std::vector<FanPlane>(static_cast<std::size_t>(mirrored ? (n + 1) / 2 : n)),
      .first_bearing = paths_.transect_bearing(),
      .sectors = n,
      .mirrored = mirrored};
  in_parallel(fan.planes.size(), [&](std::size_t i) {
    const double turn = 2.0 * pi * (static_cast<double>(i) + 0.5) / n;
    Plane plane = paths_.plane(place, fan.first_bearing + turn, settings.max_range);
    plane.cos_beta = std::cos(turn);  // to the last bit alike in mirrored sectors
    const auto solver = paths_.solver(plane);
    const Environment& ocean = solver->environment();
    fan.planes[i].paths = ground(*solver);
    fan.planes[i].ends = ends_of(*fan.planes[i].paths, speed);
    fan.planes[i].facets = facets_of(plane, level, ocean, *fan.planes[i].paths);
  });
  return fan;
}

}  // namespace asdic::detail
