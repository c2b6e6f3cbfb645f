#include "reverb/power/received_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/doppler.h"

namespace asdic::detail {
namespace {

/// The pair that takes the same two paths the other way round, if it is another one.
PathPair* reciprocal(PathPairs& pairs, const PathPair& pair) noexcept {
  for (PathPair& other : pairs.found)
    if (other.out == pair.back && other.back == pair.out && &other != &pair) return &other;
  return nullptr;
}

/// The way between an end and a place beside another one.
struct WayBeside {
  Vec2 direction;  // unit vector from the place to the end
  double longer;   // than that of the other place [m]

  WayBeside(const Vec2& end, const Vec2& own, const Vec2& place) {
    const Vec2 way = end - place;
    const double range = way.norm();
    direction = way / range;
    longer = range - (end - own).norm();
  }
};

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
  const double area = ground.area / std::max(1.0, static_cast<double>(ground.places.size()));
  const auto slowness = [&](const PathPair& pair) {
    return met_by(pair.receiver->velocity, sheet.arriving(pair));
  };
  PathPairs& pairs = memory.pairs;
  sheet.pairs_at(ground.middle, pairs, &limits, ground.ring, 0.0, ground.chance);
  memory.sounds.clear();
  memory.by.clear();
  for (PathPair& pair : pairs.found) {
    PathPair* other = sheet.one_fan() ? reciprocal(pairs, pair) : nullptr;
    double rotation = 0.0;
    if (other != nullptr) {
      rotation = omega * (other->delay - pair.delay);
      if (std::abs(rotation) > in_phase)
        other = nullptr;
      else if (pair.out_index > pair.back_index)
        continue;  // it goes with the other
    }
    const double root = std::sqrt(area * pair.area);
    const double along = steepness(pair, ground.outward);
    const double through = pair.out_ends->down + pair.back_ends->down;
    Received h{.delay = pair.delay,
               .extent = std::abs(along) * ground.length + std::abs(through) * field.thickness,
               .one = root * pair.amplitude,
               .one_slowness = slowness(pair),
               .one_length = pair.back->length,
               .doppler = sheet.doppler(pair, drift, 0.0),
               .azimuthally_symmetric = azimuthally_symmetric};
    const std::size_t part = memory.by.size();
    memory.sounds.add(sheet, pair, piece, h.doppler, h.one_slowness, part);
    if (other != nullptr) {
      h.other = root * other->amplitude * std::polar(1.0, -rotation);
      h.other_slowness = slowness(*other);
      h.other_length = other->back->length;
      memory.sounds.add(sheet, *other, piece, h.doppler, h.other_slowness, part);
    }
    memory.by.push_back({&pair, other, h});
  }
  const std::span<const double> gains = memory.sounds.gains(interference, piece, memory.by.size());
  const auto add = [&](const Received& h, const PathPair& pair) {
    if (motion.kind != ScattererMotion::Kind::bragg) {
      received.push_back(h);
      return;
    }
    // Waves that come and waves that go make two lines.
    const auto line = [&](double bragg, double share) {
      Received of = h;
      of.doppler = sheet.doppler(pair, drift, bragg);
      of.one *= std::sqrt(share);
      of.other *= std::sqrt(share);
      received.push_back(of);
    };
    line(1.0, 1.0 - motion.receding_share);
    if (motion.receding_share > 0.0) line(-1.0, motion.receding_share);
  };
  for (std::size_t i = 0; i < memory.by.size(); ++i) {
    auto& [pair, other, h] = memory.by[i];
    h.one *= gains[i];
    h.other *= gains[i];
    if (ground.places.empty()) add(h, *pair);
  }
  if (ground.places.empty() || memory.by.empty()) return;
  // Where the receiver is when the first of the pairs is received, as for the piece's own middle.
  const Vec2 receiver = sheet.ends().receiver_at(memory.by.front().pair->delay).head<2>();
  std::stable_sort(memory.by.begin(), memory.by.end(),
                   [](const ReceptionMemory::By& a, const ReceptionMemory::By& b) {
                     return std::pair(a.pair->back_index, a.pair->receiver) <
                            std::pair(b.pair->back_index, b.pair->receiver);
                   });
  const Vec2 source = sheet.ends().source.position.head<2>();
  for (const Vec2& place : ground.places) {
    const WayBeside out(source, ground.middle, place), back(receiver, ground.middle, place);
    const auto move = [&](PathPair& pair) {
      pair.leaving = -out.direction;
      pair.coming = back.direction;
    };
    const PathPair* last = nullptr;
    Vec3 home = Vec3::Zero();
    for (const auto& [pair, other, received_there] : memory.by) {
      Received h = received_there;
      move(*pair);
      if (last == nullptr || pair->back != last->back || pair->receiver != last->receiver)
        home = slowness(*pair);
      last = pair;
      h.delay += pair->out->horizontal_slowness * out.longer +
                 pair->back->horizontal_slowness * back.longer;
      h.one_slowness = home;
      if (other != nullptr) {
        move(*other);
        h.other_slowness = slowness(*other);
      }
      h.doppler = sheet.doppler(*pair, drift, 0.0);
      add(h, *pair);
    }
  }
}

}  // namespace asdic::detail
