#pragma once
#include <functional>

#include "raytrace/beams/beam.h"
#include "raytrace/beams/crossing.h"
#include "raytrace/beams/foot.h"

namespace asdic::detail::beams {

/// Hat and Gaussian beams in Cartesian coordinates: every column of receivers that the ray crosses
/// is served from the crossing. A receiver dz below it lies n = |dz·cos θ| off the ray and s =
/// dz·sin θ along its tangent; delay and q go on linearly along the tangent.
void add_cartesian(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
                   FieldSum& field);

/// One crossing of them. \param launch  widths of a hat's halves  \param launched  launch_factor
/// \param add_to  takes a row and what to add
using AddTo = std::function<void(std::size_t row, std::complex<double> value)>;
void add_crossing(const BeamSetting& setting, const BeamLaunch& launch, double launched,
                  double source_speed, const Crossing& crossing, std::span<const double> depths,
                  const AddTo& add_to);

/// Hat and Gaussian beams in ray-centred coordinates: every receiver is served from the foot of the
/// normal that meets it, where delay and q are the ray's.
void add_ray_centred(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
                     FieldSum& field);

/// What it brings to each of them. \param visit  takes the foot, the ray there and what to add
using VisitFoot = std::function<void(const Foot&, const Crossing&, std::complex<double> value)>;
void visit_ray_centred(const BeamSetting& setting, double launched, const RayTrajectory& ray,
                       FieldSum& field, const VisitFoot& visit);

/// Gaussian in the angle under which the miss distance is seen from the source, spread by arc
/// length.
void add_simple_gaussian(const BeamSetting& setting, const BeamLaunch& launch,
                         const RayTrajectory& ray, FieldSum& field);

/// One crossing of it.
void add_simple_crossing(const BeamSetting& setting, double launched, const Crossing& crossing,
                         std::span<const double> depths, const AddTo& add_to);

/// Cerveny's beams of complex curvature.
void add_cerveny_cartesian(const BeamSetting& setting, const BeamLaunch& launch,
                           const RayTrajectory& ray, FieldSum& field);
void add_cerveny_ray_centred(const BeamSetting& setting, const BeamLaunch& launch,
                             const RayTrajectory& ray, FieldSum& field);

/// Least σ of a Gaussian beam [m]: min(0.2·f·τ, π·λ). The first, a number of metres, lets beams
/// start narrow; the second keeps them open at caustics.
[[nodiscard]] double gaussian_least_width(double frequency, double time, double speed) noexcept;

/// Source pattern and, of a point source, what spreading across the plane makes of its launch:
/// √|cos α|, or √c₀ (tube_amplitude.h without what depends on where the ray gets to).
[[nodiscard]] double launch_factor(const BeamSetting& setting, const BeamLaunch& launch,
                                   double source_speed) noexcept;

}  // namespace asdic::detail::beams
