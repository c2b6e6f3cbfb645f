#include "sonar/surface_ground.h"

#include <tbb/collaborative_call_once.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>

namespace asdic {
namespace {

constexpr std::size_t most_places = 8;

/// How each cell's facet lies. A slope h′ along the transect is h′·cos β in the plane: the angle to
/// the facet is that to its line in the plane, corrected for the part of its normal that sticks out
/// of the plane.
std::vector<CellTilt> tilts(const Environment& plane, double cos_beta, const GroundPaths& paths) {
  std::vector<CellTilt> tilt;
  if (!plane.surface.shape || cos_beta == 0.0) return tilt;
  for (std::size_t cell = 0; cell < paths.cells(); ++cell) {
    const double in_plane = plane.surface.shape->at(paths.range(cell)).slope;
    const double stretch = std::hypot(1.0, in_plane / cos_beta);  // √(1 + h′²)
    tilt.push_back({.grazing = std::hypot(1.0, in_plane) / stretch, .area = stretch});
  }
  return tilt;
}

}  // namespace

struct SurfaceGround::Entry {
  tbb::collaborative_once_flag traced;  // who waits for the planes helps to trace them
  std::vector<GroundSectors> planes;
};

SurfaceGround::SurfaceGround(const PropagationPaths& paths, const Settings& settings)
    : paths_(paths), settings_(settings) {}

SurfaceGround::~SurfaceGround() = default;

std::shared_ptr<const std::vector<GroundSectors>> SurfaceGround::around(
    const Vec3& platform) const {
  const std::pair key(paths_.layered() ? 0.0 : paths_.plane(platform, 0.0).origin, platform.z());
  std::shared_ptr<Entry> entry;
  {
    const std::scoped_lock lock(lock_);
    auto& kept = kept_[key];
    if (!kept) {
      kept = std::make_shared<Entry>();
      entry = kept;
      // a platform that moves all the time: keep the newest only
      if (kept_.size() > most_places) kept_ = {{key, entry}};
    } else {
      entry = kept;
    }
  }
  tbb::collaborative_call_once(entry->traced, [&] { entry->planes = trace(platform); });
  return {entry, &entry->planes};
}

std::vector<GroundSectors> SurfaceGround::trace(const Vec3& platform) const {
  const int n = settings_.azimuths;
  const auto ground = [&](const EigenraySolver& solver) {
    return std::make_shared<const GroundPaths>(
        ground_paths(solver, platform.z(), BoundaryKind::surface, settings_.spacing,
                     settings_.max_range, settings_.frequency, settings_.limits));
  };
  if (paths_.layered()) {
    std::vector<int> all(static_cast<std::size_t>(n));
    std::iota(all.begin(), all.end(), 0);
    return {{.paths = ground(paths_.along_transect()), .tilt = {}, .sectors = std::move(all)}};
  }
  std::vector<GroundSectors> planes(static_cast<std::size_t>((n + 1) / 2));
  const double origin = paths_.plane(platform, 0.0).origin;
  tbb::parallel_for(std::size_t{0}, planes.size(), [&](std::size_t i) {
    const int k = static_cast<int>(i), mirrored = n - 1 - k;
    const Plane plane{.origin = origin, .cos_beta = std::cos(2.0 * pi * (k + 0.5) / n)};
    const auto solver = paths_.solver(plane);
    planes[i].sectors = k == mirrored ? std::vector{k} : std::vector{k, mirrored};
    planes[i].paths = ground(*solver);
    planes[i].tilt = tilts(solver->environment(), plane.cos_beta, *planes[i].paths);
  });
  return planes;
}

}  // namespace asdic
