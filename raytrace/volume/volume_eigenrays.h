#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/path_limits.h"
#include "raytrace/volume/volume_fan.h"
#include "raytrace/volume/volume_ray.h"

namespace asdic::detail {

/// What a search did.
struct VolumeSearchReport {
  std::size_t rays = 0;        ///< traced for the mesh
  std::size_t refined = 0;     ///< and to refine
  std::size_t unfinished = 0;  ///< cells of the mesh that were left unresolved around the receiver
  std::size_t given_up = 0;    ///< cells and roots that were left for cost
};

/// How near to its receiver a path is brought, and what a search may cost.
struct VolumePrecision {
  double miss = 1e-5;              ///< of the receiver [m]
  double step = 1e-7;              ///< error of a step [m]
  std::size_t most_rays = 100000;  ///< within cells, and by Newton's method where families end
};

/// All eigenrays from one place to another through a volume, sorted by delay.
///
/// Launch directions are cut into cells of elevation and azimuth, the azimuths as far from the
/// receiver's bearing as bounces off the steepest floor can turn a ray. Rays through the corners of
/// a cell that met the same boundaries in the same order are one family; each passes the receiver
/// at a miss that is a smooth function of the two angles. Where their 2 × 2 matrices agree, the
/// cell holds one root or none; where they do not and the receiver is near, the cell is cut.
/// Newton's method on both angles follows until the miss is below 10 µm.
/// docs/theory/three-dimensional-rays.md
/// \param limits  max_vertices, diffraction and the limits of delay mean nothing here
/// \param in_plane  paths in the vertical plane of both places, from which Newton's method starts
///                  as well: of families so thin that cells miss them, where rays are hardly turned
///                  out of it
[[nodiscard]] Arrivals volume_eigenrays(const VolumeTracer& tracer, const Vec3& from,
                                        const Vec3& to, const PathLimits& limits,
                                        VolumeSearchReport* report = nullptr,
                                        std::span<const Arrival> in_plane = {});

/// The same in a fan that many receivers share: the fan's rays are not counted.
/// \param told  the share that is looked at; false: no more (Interrupted is thrown)
[[nodiscard]] Arrivals volume_eigenrays(const VolumeFan& fan, const Vec3& to,
                                        VolumeSearchReport* report,
                                        const VolumePrecision& precision = {},
                                        const std::function<bool(double)>& told = {},
                                        std::span<const Arrival> in_plane = {});

/// The same path after its ends have moved by metres. Null if no ray of the same history is found
/// there: then it has to be searched for.
[[nodiscard]] std::optional<Arrival> followed_volume_path(const VolumeTracer& tracer,
                                                          const Arrival& path, const Vec3& from,
                                                          const Vec3& to);

/// The ray of a path, to be drawn: places in order. \param path  what a search gave
[[nodiscard]] std::vector<Vec3> volume_track(const VolumeTracer& tracer, const Arrival& path,
                                             const Vec3& from, const Vec3& to);

}  // namespace asdic::detail
