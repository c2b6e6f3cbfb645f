#include "reverb/power/received_places.h"

#include <cmath>

#include "core/doppler.h"

namespace asdic::detail {
namespace {

/// The pair that takes the same two paths the other way round, if it is another one.
const PathPair* reciprocal(const PathPairs& pairs, const PathPair& pair) noexcept {
  for (const PathPair& other : pairs.found)
    if (other.out == pair.back && other.back == pair.out && &other != &pair) return &other;
  return nullptr;
}

}  // namespace

void receive(const ScatteringField& field, const Ground& ground, const AudibleLimits& limits,
             const PathInterference& interference, bool azimuthally_symmetric,
             ReceptionMemory& memory, std::vector<Received>& received) {
  constexpr double in_phase = 3.0;  // [rad] further apart, two sounds are none together
  const ScatteringSheet& sheet = field.sheet;
  const ScattererMotion& motion = field.field.motion;
  const Vec3 drift(motion.current.x(), motion.current.y(), 0.0);
  const double omega = 2.0 * pi * sheet.ends().frequency;
  const GroundPiece piece{.outward = ground.outward,
                          .length = ground.length,
                          .width = ground.width,
                          .thickness = field.thickness};
  PathPairs& pairs = memory.pairs;
  sheet.pairs_at(ground.middle, pairs, &limits, ground.ring, 0.0, ground.chance);
  memory.sounds.clear();
  memory.by.clear();
  const std::size_t first = received.size();
  for (const PathPair& pair : pairs.found) {
    const PathPair* other = sheet.one_fan() ? reciprocal(pairs, pair) : nullptr;
    double rotation = 0.0;
    if (other != nullptr) {
      rotation = omega * (other->delay - pair.delay);
      if (std::abs(rotation) > in_phase)
        other = nullptr;
      else if (pair.out_index > pair.back_index)
        continue;  // it goes with the other
    }
    const double root = std::sqrt(ground.area * pair.area);
    const double along = steepness(pair, ground.outward);
    const double through = pair.out_ends->down + pair.back_ends->down;
    Received h{.delay = pair.delay,
               .extent = std::abs(along) * ground.length + std::abs(through) * field.thickness,
               .one = root * pair.amplitude,
               .one_slowness = met_by(pair.receiver->velocity, sheet.arriving(pair)),
               .one_length = pair.back->length,
               .doppler = sheet.doppler(pair, drift, 0.0),
               .azimuthally_symmetric = azimuthally_symmetric};
    const std::size_t part = memory.by.size();
    memory.sounds.add(sheet, pair, piece, h.doppler, h.one_slowness, part);
    if (other != nullptr) {
      h.other = root * other->amplitude * std::polar(1.0, -rotation);
      h.other_slowness = met_by(other->receiver->velocity, sheet.arriving(*other));
      h.other_length = other->back->length;
      memory.sounds.add(sheet, *other, piece, h.doppler, h.other_slowness, part);
    }
    received.push_back(h);
    memory.by.push_back(&pair);
  }
  const std::span<const double> gains = memory.sounds.gains(interference, piece, memory.by.size());
  for (std::size_t i = 0; i < gains.size(); ++i) {
    received[first + i].one *= gains[i];
    received[first + i].other *= gains[i];
  }
  if (motion.kind != ScattererMotion::Kind::bragg) return;
  // By waves that come and by those that go: two lines.
  for (std::size_t i = 0; i < memory.by.size(); ++i) {
    Received goes = received[first + i];
    const auto line = [&](Received& h, double bragg, double share) {
      h.doppler = sheet.doppler(*memory.by[i], drift, bragg);
      h.one *= std::sqrt(share);
      h.other *= std::sqrt(share);
    };
    line(goes, -1.0, motion.receding_share);
    line(received[first + i], 1.0, 1.0 - motion.receding_share);
    if (motion.receding_share > 0.0) received.push_back(goes);
  }
}

}  // namespace asdic::detail
