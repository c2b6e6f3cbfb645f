#include "reverb/fields/met_scatterer.h"

#include <algorithm>
#include <cmath>

#include "core/mixed_bits.h"
#include "core/random.h"

namespace asdic::detail {
namespace {

/// Three normals that belong to a scatterer, held at four standard deviations.
Vec3 own_velocity(double rms, std::uint64_t entity, std::uint64_t seed) {
  if (rms <= 0.0) return Vec3::Zero();
  RandomStream draw(seed, Draw::scatterer_velocity, 0, entity);
  Vec3 velocity;
  for (int i = 0; i < 3; ++i) velocity[i] = rms * std::clamp(draw.normal(), -4.0, 4.0);
  return velocity;
}

}  // namespace

MetScatterer meet(const ScatteringField& field, const ScattererKey& key, std::uint64_t entity,
                  const ScattererMeeting& meeting, PathPairs& pairs) {
  const ScattererMotion& motion = field.field.motion;
  const ScattererStatistics& statistics = field.field.statistics;
  const Scatterer scatterer = place_scatterer(field.grid, key, entity, meeting.seed);
  field.sheet.pairs_at(scatterer.place, pairs, meeting.limits, field.received_area(key.ring),
                       (scatterer.depth_share - 0.5) * field.thickness,
                       mixed(entity, statistics.coherence_time > 0.0 ? 0 : meeting.ping));
  MetScatterer met;
  if (pairs.found.empty()) return met;
  const Vec2 in_water = scatterer.place - motion.current * meeting.time;
  met.strength = field.share * std::sqrt(scatterer.area * pairs.found.front().area) *
                 texture_amplitude(statistics, in_water, field.boundary, meeting.seed);
  met.velocity = {motion.current.x(), motion.current.y(), 0.0};
  if (motion.kind == ScattererMotion::Kind::bragg)
    met.bragg = scatterer.fate < motion.receding_share ? -1.0 : 1.0;
  else if (motion.kind == ScattererMotion::Kind::spread)
    met.velocity += own_velocity(motion.speed_rms, entity, meeting.seed);
  return met;
}

}  // namespace asdic::detail
