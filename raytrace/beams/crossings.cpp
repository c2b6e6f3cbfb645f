#include "raytrace/beams/crossings.h"

#include "raytrace/beams/crossing.h"

namespace asdic {

void Crossings::resize(std::size_t n) {
  column.resize(n);
  for (auto* array : {&depth, &cosine, &sine, &speed, &time, &q, &dq_ds, &level, &phase, &mirror})
    array->resize(n);
}

void find_crossings(const RayTrajectory& ray, std::span<const double> ranges, Crossings& out) {
  out.resize(0);
  out.source_speed = ray.source_speed;
  for (const RaySegment& segment : ray.segments)
    for_each_crossing(segment, ranges, [&](std::size_t column, const RayState& state) {
      const Crossing x = crossing_of(segment, state);
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

}  // namespace asdic
