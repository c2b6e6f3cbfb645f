#include <algorithm>
#include <numbers>

#include "core/doppler.h"
#include "reverb/scattering/motion.h"
#include "reverb/scattering_sheet.h"

namespace asdic {

Vec3 ScatteringSheet::arriving(const PathPair& pair) const noexcept {
  const double level = pair.back_ends->launch_level;
  return {level * pair.coming.x(), level * pair.coming.y(), -pair.back_ends->launch_down};
}

double ScatteringSheet::fastest_ends() const noexcept {
  double heard = ends_.receiver.velocity.norm();
  for (const ReceiverLeg& leg : ends_.legs) heard = std::max(heard, leg.line.velocity.norm());
  return ends_.source.velocity.norm() + heard;
}

double ScatteringSheet::doppler(const PathPair& pair, const Vec3& velocity,
                                double bragg) const noexcept {
  double factor = 1.0;
  if (moving_) {
    const double level = pair.out_ends->launch_level;
    const Vec3 leaving(level * pair.leaving.x(), level * pair.leaving.y(),
                       pair.out_ends->launch_down);
    factor =
        leg_doppler({ends_.source.velocity, leaving}, {pair.receiver->velocity, arriving(pair)});
  }
  const Vec2 in = pair.out->horizontal_slowness * pair.leaving;
  const Vec2 home = pair.back->horizontal_slowness * pair.coming;
  if (!velocity.isZero()) {  // slowness at the scatterer; what came down goes up again
    const Vec3 comes(in.x(), in.y(), pair.out_ends->down);
    const Vec3 goes(home.x(), home.y(), -pair.back_ends->down);
    factor *= leg_doppler({velocity, goes}, {velocity, comes});  // a receiver, and a sender again
  }
  if (bragg != 0.0)
    factor *= 1.0 + bragg * bragg_shift(scattering_wavenumber(in, home, ends_.frequency)) /
                        ends_.frequency;
  return factor;
}

namespace {

/// The largest slownesses of a fan's paths [s/m].
struct Slownesses {
  double launch_level = 0.0, launch_down = 0.0;  // at the launch
  double level = 0.0, down = 0.0;                // at the boundary
  double least_level = infinity;
};

Slownesses slownesses(const BoundaryFan& fan) {
  Slownesses s;
  for (const FanPlane& plane : fan.planes) {
    for (const PathEnds& ends : plane.ends) {
      s.launch_level = std::max(s.launch_level, ends.launch_level);
      s.launch_down = std::max(s.launch_down, std::abs(ends.launch_down));
      s.down = std::max(s.down, std::abs(ends.down));
    }
    for (const GroundPath& path : plane.paths->all()) {
      s.level = std::max(s.level, path.horizontal_slowness);
      s.least_level = std::min(s.least_level, path.horizontal_slowness);
    }
  }
  return s;
}

/// (1 ± a)/(1 ± b) at their extremes.
DopplerSpan ratio(double a, double b) noexcept {
  return {(1.0 - a) / (1.0 + b), (1.0 + a) / (1.0 - b)};
}

}  // namespace

std::vector<DopplerSpan> ScatteringSheet::dopplers(const ScattererMotion& motion) const {
  const Slownesses out = slownesses(*out_), back = slownesses(*back_);
  const auto along = [](const Vec3& velocity, double level, double down) {
    return velocity.head<2>().norm() * level + std::abs(velocity.z()) * down;
  };
  double heard = along(ends_.receiver.velocity, back.launch_level, back.launch_down);
  for (const ReceiverLeg& leg : ends_.legs)
    heard = std::max(heard, along(leg.line.velocity, back.launch_level, back.launch_down));
  const DopplerSpan ends =
      ratio(heard, along(ends_.source.velocity, out.launch_level, out.launch_down));
  // A scatterer's own velocity is held at four standard deviations of each component.
  const double own = motion.kind == ScattererMotion::Kind::spread ? 4.0 * motion.speed_rms : 0.0;
  const Vec3 fastest(motion.current.norm() + std::numbers::sqrt2 * own, 0.0, own);
  const DopplerSpan sea =
      ratio(along(fastest, out.level, out.down), along(fastest, back.level, back.down));
  const DopplerSpan both = {ends.lowest * sea.lowest, ends.highest * sea.highest};
  if (motion.kind != ScattererMotion::Kind::bragg) return {both};
  // √(gQ)/2π over the frequency, |Q| ≤ 2πf(ξ_out + ξ_back), and just that straight back.
  const double k = 2.0 * pi * ends_.frequency;
  const double most = bragg_shift(k * (out.level + back.level)) / ends_.frequency;
  const double least =
      one_place_
          ? bragg_shift(2.0 * k * std::min(out.least_level, back.least_level)) / ends_.frequency
          : 0.0;
  return {{both.lowest * (1.0 - most), both.highest * (1.0 - least)},
          {both.lowest * (1.0 + least), both.highest * (1.0 + most)}};
}

}  // namespace asdic
