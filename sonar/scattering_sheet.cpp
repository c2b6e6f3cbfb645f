#include "sonar/scattering_sheet.h"

#include <algorithm>

#include "reverb/scattering/motion.h"
#include "sonar/doppler.h"

namespace asdic {

ScatteringSheet::ScatteringSheet(std::shared_ptr<const BoundaryFan> out,
                                 std::shared_ptr<const BoundaryFan> back, Law law, double side,
                                 const SheetEnds& ends, const TransmitPattern& pattern)
    : out_(std::move(out)),
      back_(std::move(back)),
      law_(std::move(law)),
      side_(side),
      ends_(ends),
      pattern_(pattern),
      all_round_pattern_(pattern.all_round() && out_->planes.size() == 1),
      receiver_moves_(!ends.receiver.velocity.isZero()),
      moving_(receiver_moves_ || !ends.source.velocity.isZero()) {
  if (!all_round_pattern_) return;
  for (const GroundPath& path : out_->planes.front().paths->all())
    beam_.push_back(pattern_.towards(0.0, path.launch_elevation));
}

bool ScatteringSheet::all_round() const noexcept {
  return all_round_pattern_ && back_->planes.size() == 1 &&
         (ends_.source.position - ends_.receiver.position).head<2>().norm() < 1e-3;
}

ScatteringSheet::Leg ScatteringSheet::leg(const BoundaryFan& fan, const Vec2& end,
                                          const Vec2& place, bool bearing) const noexcept {
  Leg found;
  const Vec2 way = place - end;
  const double range = way.norm();
  found.direction = range > 0.0 ? Vec2(way / range) : Vec2(0.0, 1.0);
  if (bearing || fan.planes.size() > 1)
    found.bearing = std::atan2(found.direction.x(), found.direction.y());
  const FanPlane& plane = fan.towards(found.bearing);
  const GroundPaths& paths = *plane.paths;
  const double cells = range / paths.spacing();
  if (!(cells < static_cast<double>(paths.cells()))) return found;
  const auto cell = static_cast<std::size_t>(cells);
  found.paths = paths.paths(cell);
  found.beyond = range - paths.range(cell);
  if (!plane.tilt.empty()) found.tilt = &plane.tilt[cell];
  found.first = static_cast<std::size_t>(found.paths.data() - paths.all().data());
  return found;
}

double ScatteringSheet::grazing(const Leg& leg, const GroundPath& path) const noexcept {
  if (!leg.tilt) return path.grazing;
  return std::asin(std::min(1.0, std::sin(path.grazing) * leg.tilt->grazing));
}

void ScatteringSheet::pairs_at(const Vec2& place, std::vector<PathPair>& pairs,
                               const AudibleLimits* limits, double ring) const {
  constexpr double strongest = 2.0;  // [1/sr] no law says more
  pairs.clear();
  const Leg out = leg(*out_, ends_.source.position.head<2>(), place, !all_round_pattern_);
  if (out.paths.empty()) return;
  Vec2 receiver = ends_.receiver.position.head<2>();
  Leg back = leg(*back_, receiver, place, false);
  if (back.paths.empty()) return;
  // Where the receiver is when the first path is heard: all others are heard metres from there.
  double heard = 0.0;
  if (receiver_moves_) {
    heard = out.paths.front().delay + back.paths.front().delay;
    receiver += ends_.receiver.velocity.head<2>() * heard;
    back = leg(*back_, receiver, place, false);
    if (back.paths.empty()) return;
  }
  const Vec2 coming = -back.direction;
  // Towards the scatterer [m/s]: the way back changes by −closing·(t − heard).
  const double closing = ends_.receiver.velocity.head<2>().dot(back.direction);
  const double turn = std::acos(std::clamp(out.direction.dot(coming), -1.0, 1.0));
  for (std::size_t i = 0; i < out.paths.size(); ++i) {
    const GroundPath& a = out.paths[i];
    const std::complex<double> beam = all_round_pattern_
                                          ? beam_[out.first + i]
                                          : pattern_.towards(out.bearing, a.launch_elevation);
    const std::complex<double> sent = a.amplitude * beam;
    const double there = a.delay + a.horizontal_slowness * out.beyond;
    const double in = grazing(out, a);
    for (const GroundPath& b : back.paths) {
      double delay = there + b.delay + b.horizontal_slowness * back.beyond;
      if (receiver_moves_) {
        // t = τ_out + τ_back − ξ·closing·(t − heard) + s_z·v_z·t, solved for t.
        const double along = b.horizontal_slowness * closing;
        const double down =
            std::sin(b.launch_elevation) / ends_.receiver_speed * ends_.receiver.velocity.z();
        delay = (delay + along * heard) / (1.0 + along - down);
      }
      if (delay > ends_.latest) continue;
      const double least = limits ? limits->at(delay) : 0.0;
      const double power = std::norm(sent) * std::norm(b.amplitude) * ring;
      if (limits && power * strongest < least) continue;
      const double home = grazing(back, b);
      const double sigma = std::visit(
          [&](const auto& law) {
            return law.cross_section({.grazing_in = in, .grazing_out = home, .azimuth = turn},
                                     ends_.frequency);
          },
          law_);
      if (sigma <= 0.0 || (limits && power * sigma < least)) continue;
      pairs.push_back({.out = &a,
                       .back = &b,
                       .delay = delay,
                       .amplitude = sent * b.amplitude * std::sqrt(sigma),
                       .cross_section = sigma,
                       .grazing_in = in,
                       .grazing_out = home,
                       .area = out.tilt ? out.tilt->area : 1.0,
                       .leaving = out.direction,
                       .coming = coming});
    }
  }
}

Vec3 ScatteringSheet::arriving(const PathPair& pair) const noexcept {
  const double level = std::cos(pair.back->launch_elevation) / ends_.receiver_speed;
  return {level * pair.coming.x(), level * pair.coming.y(),
          std::sin(pair.back->launch_elevation) / ends_.receiver_speed};
}

double ScatteringSheet::doppler(const PathPair& pair, const Vec3& velocity,
                                double bragg) const noexcept {
  double factor = 1.0;
  if (moving_) {
    const double level = std::cos(pair.out->launch_elevation) / ends_.source_speed;
    const Vec3 leaving(level * pair.leaving.x(), level * pair.leaving.y(),
                       -std::sin(pair.out->launch_elevation) / ends_.source_speed);
    factor = leg_doppler({ends_.source.velocity, leaving}, {}) *
             leg_doppler({}, {ends_.receiver.velocity, arriving(pair)});
  }
  const Vec2 in = pair.out->horizontal_slowness * pair.leaving;
  const Vec2 home = pair.back->horizontal_slowness * pair.coming;
  if (!velocity.isZero()) {
    // Slowness at the scatterer: down to the bottom and up again, or up to the surface and down.
    const Vec3 comes(in.x(), in.y(), side_ * in.norm() * std::tan(pair.out->grazing));
    const Vec3 goes(home.x(), home.y(), -side_ * home.norm() * std::tan(pair.back->grazing));
    factor *= leg_doppler({}, {velocity, comes}) * leg_doppler({velocity, goes}, {});
  }
  if (bragg != 0.0)
    factor *= 1.0 + bragg * bragg_shift(scattering_wavenumber(in, home, ends_.frequency)) /
                        ends_.frequency;
  return factor;
}

double ScatteringSheet::nearest_end(const Vec2& place, double depth) const noexcept {
  const auto distance = [&](const Vec3& end) {
    return std::hypot((place - end.head<2>()).norm(), end.z() - depth);
  };
  return std::min(distance(ends_.source.position), distance(ends_.receiver.position));
}

}  // namespace asdic
