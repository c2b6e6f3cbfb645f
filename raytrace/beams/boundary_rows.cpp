#include "raytrace/beams/boundary_rows.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "raytrace/beams/foot.h"
#include "raytrace/beams/geometric.h"
#include "raytrace/tracing/reflected.h"

namespace asdic::detail {

namespace {

constexpr double on_boundary = 1e-3;       // [m]
constexpr double least_reflection = 1e-3;  // below it the incident wave is not had from it

}  // namespace

BoundaryRows::BoundaryRows(const Environment& environment, double frequency,
                           const ReceiverGrid& grid, bool coherent)
    : environment_(environment), frequency_(frequency), coherent_(coherent), ranges_(grid.ranges) {
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
      silent[j] = coherent && wall(kind).roughness.smooth() &&
                  std::holds_alternative<Vacuum>(wall(kind).material_at(grid.ranges[j]));
    const bool surface = kind == BoundaryKind::surface;
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (rows[j] >= 0 && silent[j] == 0) received_[surface ? 0 : 1] = true;
    if (std::equal(rows.begin() + 1, rows.end(), rows.begin()))
      same_row_[surface ? 0 : 1] = rows.front();
    (surface ? silent_surface_ : silent_bottom_) = std::move(silent);
    (surface ? surface_ : bottom_) = std::move(rows);
  }
}

std::complex<double> WallMeeting::partner() const noexcept {
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
  std::complex<double> reflection = reflection_coefficient(
      boundary.material_at(range), grazing,
      {.speed = c, .density = environment_.water_density.at(depth), .frequency = frequency_});
  if (!boundary.roughness.smooth())
    reflection *= left_by_roughness(boundary.roughness, std::sin(grazing),
                                    2.0 * pi * frequency_ / c, coherent_);
  return {true, into_water >= 0.0, slope, reflection};
}

BeamPairs::BeamPairs(const BoundaryRows& rows, const FieldSum& field) : rows_(rows) {
  for (AtWall& wall : walls_) {
    for (std::size_t j = 0; j < field.ranges.size(); ++j)
      if (const std::int32_t row = rows.row(wall.kind, j); row >= 0) {
        const auto k = static_cast<std::size_t>(row);
        wall.ranges.push_back(field.ranges[j]);
        wall.depths.push_back(field.column_depths(j)[k]);
        wall.column.push_back(j), wall.row.push_back(k);
      }
    wall.field.ranges = wall.ranges, wall.field.depths = wall.depths;
    wall.field.irregular = true;
    wall.field.sum.resize(wall.ranges.size());  // its places tell the receivers
  }
}

void BeamPairs::add(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
                    FieldSum& field) {
  const double launched = beams::launch_factor(setting, launch, ray.source_speed);
  switch (setting.kind) {
    case BeamKind::hat:
    case BeamKind::gaussian:
    case BeamKind::simple_gaussian:
      break;
    case BeamKind::ray_centred_hat:
    case BeamKind::ray_centred_gaussian:
      return add_ray_centred(setting, launched, ray, field);
    case BeamKind::cerveny_cartesian:
    case BeamKind::cerveny_ray_centred:
      return;
  }
  for (const RaySegment& segment : ray.segments)
    for_each_crossing(segment, field.ranges, [&](std::size_t column, const RayState& state) {
      for (const AtWall& wall : walls_) {
        const std::int32_t row = rows_.row(wall.kind, column);
        if (row < 0) continue;
        Crossing x = crossing_of(setting, segment, state);
        x.loss *= rows_.partner(wall.kind, column, x);
        const auto k = static_cast<std::size_t>(row);
        const auto depth = field.column_depths(column).subspan(k, 1);
        const auto put = [&](std::size_t, std::complex<double> p) { field.column(column)[k] += p; };
        if (setting.kind == BeamKind::simple_gaussian)
          beams::add_simple_crossing(setting, launched, x, depth, put);
        else
          beams::add_crossing(setting, launch, launched, ray.source_speed, x, depth, put);
      }
    });
}

void BeamPairs::silence(FieldSum& field) const {
  for (const AtWall& wall : walls_)
    for (std::size_t i = 0; i < wall.column.size(); ++i)
      if (rows_.silent(wall.kind, wall.column[i])) field.column(wall.column[i])[wall.row[i]] = 0.0;
}

void BeamPairs::add_ray_centred(const BeamSetting& setting, double launched,
                                const RayTrajectory& ray, FieldSum& field) {
  for (AtWall& wall : walls_) {
    if (wall.ranges.empty()) continue;
    beams::visit_ray_centred(
        setting, launched, ray, wall.field,
        [&](const Foot& foot, const Crossing& x, std::complex<double> p) {
          const auto i = static_cast<std::size_t>(foot.sum - wall.field.sum.data());
          const std::complex<double> partner = rows_.partner(wall.kind, wall.column[i], x);
          field.column(wall.column[i])[wall.row[i]] +=
              setting.coherent ? p * partner : p * std::norm(partner);
        });
  }
}

}  // namespace asdic::detail
