#include "sonar/heard_places.h"

#include <cmath>

#include "sonar/moving_paths.h"

namespace asdic {
namespace {

/// The pair that takes the same two paths the other way round, if it is another one.
const PathPair* reciprocal(const PathPairs& pairs, const PathPair& pair) noexcept {
  for (const PathPair& other : pairs.found)
    if (other.out == pair.back && other.back == pair.out && &other != &pair) return &other;
  return nullptr;
}

}  // namespace

void hear(const ScatteringField& field, const Ground& ground, const AudibleLimits& limits,
          bool all_round, PathPairs& pairs, std::vector<Heard>& heard) {
  constexpr double in_phase = 3.0;  // [rad] further apart, two sounds are none together
  const ScatteringSheet& sheet = field.sheet;
  const ScattererMotion& motion = field.field.motion;
  const Vec3 drift(motion.current.x(), motion.current.y(), 0.0);
  const double omega = 2.0 * pi * sheet.ends().frequency;
  sheet.pairs_at(ground.middle, pairs, &limits, ground.ring, 0.0, ground.chance);
  for (const PathPair& pair : pairs.found) {
    const PathPair* other = sheet.one_fan() ? reciprocal(pairs, pair) : nullptr;
    double turn = 0.0;
    if (other != nullptr) {
      turn = omega * (other->delay - pair.delay);
      if (std::abs(turn) > in_phase)
        other = nullptr;
      else if (pair.out_index > pair.back_index)
        continue;  // it goes with the other
    }
    const double root = std::sqrt(ground.area * pair.area);
    const double along = pair.out->horizontal_slowness * pair.leaving.dot(ground.outward) -
                         pair.back->horizontal_slowness * pair.coming.dot(ground.outward);
    const double through = pair.out_ends->down + pair.back_ends->down;
    Heard h{.delay = pair.delay,
            .extent = std::abs(along) * ground.length + std::abs(through) * field.thickness,
            .one = root * pair.amplitude,
            .one_slowness = met_by(pair.receiver->velocity, sheet.arriving(pair)),
            .one_length = pair.back->length,
            .all_round = all_round};
    if (other != nullptr) {
      h.other = root * other->amplitude * std::polar(1.0, -turn);
      h.other_slowness = met_by(other->receiver->velocity, sheet.arriving(*other));
      h.other_length = other->back->length;
    }
    if (motion.kind != ScattererMotion::Kind::bragg) {
      h.doppler = sheet.doppler(pair, drift, 0.0);
      heard.push_back(h);
      continue;
    }
    for (const double bragg : {-1.0, 1.0}) {
      const double share = bragg < 0.0 ? motion.receding_share : 1.0 - motion.receding_share;
      if (!(share > 0.0)) continue;
      Heard line = h;
      line.doppler = sheet.doppler(pair, drift, bragg);
      line.one *= std::sqrt(share);
      line.other *= std::sqrt(share);
      heard.push_back(line);
    }
  }
}

}  // namespace asdic
