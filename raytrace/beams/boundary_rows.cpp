#include "raytrace/beams/boundary_rows.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "raytrace/beams/geometric.h"

namespace asdic {

namespace {

constexpr double on_boundary = 1e-3;       // [m]
constexpr double least_reflection = 1e-3;  // below it the incident wave is not had from it

}  // namespace

BoundaryRows::BoundaryRows(const Environment& environment, double frequency,
                           const ReceiverGrid& grid)
    : environment_(environment), frequency_(frequency), ranges_(grid.ranges) {
  for (const BoundaryKind kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
    std::vector<std::int32_t> rows(grid.ranges.size(), -1);
    bool any = false;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const double z = wall(kind).depth_at(grid.ranges[j]);
      if (grid.irregular) {
        if (std::abs(grid.depths[j] - z) < on_boundary) rows[j] = 0;
      } else {
        const auto at = std::lower_bound(grid.depths.begin(), grid.depths.end(), z - on_boundary);
        if (at != grid.depths.end() && *at < z + on_boundary)
          rows[j] = static_cast<std::int32_t>(at - grid.depths.begin());
      }
      any = any || rows[j] >= 0;
    }
    if (!any) continue;
    std::vector<std::int8_t> silent(rows.size());
    for (std::size_t j = 0; j < rows.size(); ++j)
      silent[j] = wall(kind).roughness.smooth() &&
                  std::holds_alternative<Vacuum>(wall(kind).material_at(grid.ranges[j]));
    const bool surface = kind == BoundaryKind::surface;
    (surface ? silent_surface_ : silent_bottom_) = std::move(silent);
    (surface ? surface_ : bottom_) = std::move(rows);
  }
}

std::complex<double> WallMeeting::twin() const noexcept {
  if (!there) return 0.0;
  if (!reflected) return reflection;
  return std::abs(reflection) < least_reflection ? 0.0 : 1.0 / reflection;
}

WallMeeting BoundaryRows::meeting(BoundaryKind kind, std::size_t column, double cosine_here,
                                  double sine_here, double speed) const noexcept {
  const Boundary& boundary = wall(kind);
  const double range = ranges_[column], depth = boundary.depth_at(range);
  const double c = sound_speed(environment_, range, depth).c;
  const double cosine = cosine_here * c / speed;  // Snell
  if (!(std::abs(cosine) < 1.0)) return {};
  const double sine = std::copysign(std::sqrt(1.0 - cosine * cosine), sine_here);
  const double slope = boundary.shape ? boundary.shape->at(range).slope : 0.0;
  const double sense = kind == BoundaryKind::surface ? 1.0 : -1.0;  // n into the water
  const double into_water = sense * (sine - slope * cosine) / std::sqrt(1.0 + slope * slope);
  const double grazing = std::asin(std::min(std::abs(into_water), 1.0));
  std::complex<double> reflection =
      reflection_coefficient(boundary.material_at(range), grazing,
                             {.speed = c, .density = environment_.water_density.at(depth)});
  if (!boundary.roughness.smooth())
    reflection *=
        coherent_reflection(boundary.roughness, std::sin(grazing), 2.0 * pi * frequency_ / c);
  return {true, into_water >= 0.0, slope, reflection};
}

void beams::add_twins(const BeamSetting& setting, const BeamLaunch& launch,
                      const RayTrajectory& ray, const BoundaryRows& rows, FieldSum& field) {
  const double launched = launch_factor(setting, launch);
  for (const RaySegment& segment : ray.segments)
    for_each_crossing(segment, field.ranges, [&](std::size_t column, const RayState& state) {
      for (const BoundaryKind kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
        const std::int32_t row = rows.row(kind, column);
        if (row < 0) continue;
        Crossing x = crossing_of(segment, state);
        x.loss *= rows.twin(kind, column, x);
        const auto k = static_cast<std::size_t>(row);
        add_crossing(setting, launch, launched, ray.source_speed, x,
                     field.column_depths(column).subspan(k, 1),
                     [&](std::size_t, std::complex<double> p) { field.column(column)[k] += p; });
      }
    });
}

}  // namespace asdic
