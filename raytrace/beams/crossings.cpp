#include "raytrace/beams/crossings.h"

#include <cmath>

#include "core/units.h"
#include "raytrace/beams/crossing.h"

namespace asdic::detail {

void Crossings::resize(std::size_t n) {
  column.resize(n);
  for (auto* array : {&depth, &cosine, &sine, &speed, &time, &q, &dq_ds, &level, &phase, &mirror})
    array->resize(n);
}

void pick_columns(const Crossings& from, std::size_t first, std::size_t every, Crossings& out) {
  const std::size_t n = from.size();
  out.source_speed = from.source_speed;
  out.resize(n);
  std::size_t picked = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t column = from.column[i];
    if (column < first || (column - first) % every != 0) continue;
    out.column[picked] = static_cast<std::uint32_t>((column - first) / every);
    out.depth[picked] = from.depth[i];
    out.cosine[picked] = from.cosine[i], out.sine[picked] = from.sine[i];
    out.speed[picked] = from.speed[i], out.time[picked] = from.time[i];
    out.q[picked] = from.q[i], out.dq_ds[picked] = from.dq_ds[i];
    out.level[picked] = from.level[i], out.phase[picked] = from.phase[i];
    out.mirror[picked] = from.mirror[i];
    ++picked;
  }
  out.resize(picked);
}

void find_crossings(const BeamSetting& setting, const RayTrajectory& ray,
                    std::span<const double> ranges, Crossings& out) {
  out.resize(0);
  out.source_speed = ray.source_speed;
  for (const RaySegment& segment : ray.segments)
    for_each_crossing(segment, ranges, [&](std::size_t column, const RayState& state) {
      const Crossing x = crossing_of(setting, segment, state);
      out.column.push_back(static_cast<std::uint32_t>(column));
      out.depth.push_back(x.depth);
      out.cosine.push_back(x.cosine);
      out.sine.push_back(x.sine);
      out.speed.push_back(x.speed);
      out.time.push_back(x.time);
      out.q.push_back(x.q);
      out.dq_ds.push_back(x.dq_ds);
      out.level.push_back(std::abs(x.loss));
      out.phase.push_back(std::arg(x.loss));
      out.mirror.push_back(x.mirror);
    });
}

void MarchedCrossings::pass(std::size_t column, const RayState& y, const RayHistory& history) {
  const double c = 1.0 / std::sqrt(y.xi * y.xi + y.zeta * y.zeta);
  const int bounces = history.surface_bounces + history.bottom_bounces;
  const double cycles = 0.25 * history.caustics + history.reflection_phase / (2.0 * pi);
  out_.column.push_back(static_cast<std::uint32_t>(column));
  out_.depth.push_back(y.depth);
  out_.cosine.push_back(c * y.xi);
  out_.sine.push_back(c * y.zeta);
  out_.speed.push_back(c);
  out_.time.push_back(y.time);
  out_.q.push_back(y.q);
  out_.dq_ds.push_back(c * y.p);
  out_.level.push_back(std::abs(reflected(history, setting_.coherent)) *
                       (std::exp(-y.nepers) * spread_across(setting_, y)));
  out_.phase.push_back(2.0 * pi * (cycles - std::floor(cycles)));
  out_.mirror.push_back(bounces % 2 == 0 ? 1.0 : -1.0);
  out_.bounces.push_back(static_cast<std::uint32_t>(history.bottom_bounces) +
                         65536U * static_cast<std::uint32_t>(history.surface_bounces));
}

}  // namespace asdic::detail
