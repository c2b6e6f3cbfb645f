#include "sonar/scattering_sheet.h"

#include <algorithm>
#include <numbers>

#include "reverb/scattering/motion.h"

namespace asdic {
namespace {

/// From a cell's centre on: the delay's Taylor series to the second order, whose last term is held
/// where a caustic makes it large.
double delay_beyond(const GroundPath& path, double beyond) noexcept {
  const double bend = std::clamp(0.5 * path.slowness_slope * beyond,
                                 -0.1 * path.horizontal_slowness, 0.1 * path.horizontal_slowness);
  return path.delay + (path.horizontal_slowness + bend) * beyond;
}

double grazing_of(const GroundPath& path, const PathEnds& ends, const CellTilt* tilt) noexcept {
  return tilt ? std::asin(std::min(1.0, ends.sine * tilt->grazing)) : path.grazing;
}

}  // namespace

ScatteringSheet::ScatteringSheet(std::shared_ptr<const BoundaryFan> out,
                                 std::shared_ptr<const BoundaryFan> back, Law law,
                                 const SheetEnds& ends, const TransmitPattern& pattern)
    : out_(std::move(out)),
      back_(std::move(back)),
      law_(std::move(law)),
      ends_(ends),
      pattern_(pattern),
      all_round_pattern_(pattern.all_round() && out_->planes.size() == 1),
      receiver_moves_(!ends.receiver.velocity.isZero()),
      moving_(receiver_moves_ || !ends.source.velocity.isZero()),
      one_place_(out_ == back_ && !receiver_moves_ &&
                 ends.source.position == ends.receiver.position) {
  if (!all_round_pattern_) return;
  const auto ask = [&](const TransmitPattern& at) {
    for (const GroundPath& path : out_->planes.front().paths->all())
      beam_.push_back(at.towards(0.0, path.launch_elevation));
  };
  ask(pattern_);
  for (const BandPoint& point : ends_.band) ask(*point.pattern);
}

/// What is sent along a path out. \param point  0: the centre, then those of the band
std::complex<double> ScatteringSheet::beam(const Leg& out, std::size_t path,
                                           std::size_t point) const noexcept {
  if (all_round_pattern_)
    return beam_[point * out_->planes.front().paths->size() + out.first + path];
  const TransmitPattern& pattern = point == 0 ? pattern_ : *ends_.band[point - 1].pattern;
  return pattern.towards(out.bearing, out.paths[path].launch_elevation);
}

double ScatteringSheet::cross_section(const ScatterGeometry& geometry,
                                      double frequency) const noexcept {
  return std::visit([&](const auto& law) { return law.cross_section(geometry, frequency); }, law_);
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
  found.range = range;
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
  found.ends = plane.ends.data() + found.first;
  return found;
}

void ScatteringSheet::pairs_at(const Vec2& place, PathPairs& pairs, const AudibleLimits* limits,
                               double ring, double below) const {
  constexpr double strongest = 2.0;  // [1/sr] no law says more
  pairs.found.clear();
  pairs.colours.clear();
  const std::size_t points = ends_.band.size();
  const Leg out = leg(*out_, ends_.source.position.head<2>(), place, !all_round_pattern_);
  if (out.paths.empty()) return;
  const Vec2 receiver = ends_.receiver.position.head<2>();
  Leg back = one_place_ ? out : leg(*back_, receiver, place, false);
  if (back.paths.empty()) return;
  // Where the receiver is when the first path is heard: all others are heard metres from there.
  double heard = 0.0;
  if (receiver_moves_) {
    heard = out.paths.front().delay + back.paths.front().delay;
    back = leg(*back_, receiver + ends_.receiver.velocity.head<2>() * heard, place, false);
    if (back.paths.empty()) return;
  }
  const Vec2 coming = -back.direction;
  // Towards the scatterer [m/s]: the way back shrinks by closing·(t − heard).
  const double closing = ends_.receiver.velocity.head<2>().dot(back.direction);
  const double sinking = ends_.receiver.velocity.z();
  const double across2 =  // v² across the way over its length: how fast the way bends [m/s²]
      (ends_.receiver.velocity.head<2>().squaredNorm() - closing * closing) /
      std::max(1.0, back.range);
  const double turn = one_place_ ? pi : std::acos(std::clamp(out.direction.dot(coming), -1.0, 1.0));
  constexpr double same_turn = 1e-6;  // [rad]
  if (out.tilt || back.tilt || pairs.sheet_ != this || pairs.out_ != out.first ||
      pairs.back_ != back.first || std::abs(pairs.turn_ - turn) > same_turn ||
      pairs.sigma_.size() != out.paths.size() * back.paths.size() * (1 + points)) {
    pairs.sheet_ = this;
    pairs.out_ = out.first;
    pairs.back_ = back.first;
    pairs.turn_ = turn;
    pairs.sigma_.assign(out.paths.size() * back.paths.size() * (1 + points), -1.0);
  }
  for (std::size_t i = 0; i < out.paths.size(); ++i) {
    const GroundPath& a = out.paths[i];
    const PathEnds& a_ends = out.ends[i];
    const std::complex<double> sent = a.amplitude * beam(out, i, 0);
    if (sent == 0.0 && points == 0) continue;
    const double there = delay_beyond(a, out.beyond) + a_ends.down * below;
    for (std::size_t j = 0; j < back.paths.size(); ++j) {
      const GroundPath& b = back.paths[j];
      const PathEnds& b_ends = back.ends[j];
      double delay = there + delay_beyond(b, back.beyond) + b_ends.down * below;
      if (receiver_moves_) {
        // t = τ_out + τ_back − ξ·closing·(t − heard) + s_z·v_z·t, solved for t. The sound arrives
        // against the direction in which b was launched: s_z is minus its vertical slowness.
        const double along = b.horizontal_slowness * closing;
        const double down = -b_ends.launch_down * sinking;
        delay = (delay + along * heard) / (1.0 + along - down);
        // What is not linear: the way bends, and the slowness changes along it.
        const double later = delay - heard, held = 0.2 * b.horizontal_slowness;
        const double bend = std::clamp(b.slowness_slope * closing * later, -held, held);
        delay += 0.5 * later * (b.horizontal_slowness * across2 * later + bend * closing);
      }
      if (delay > ends_.latest) continue;
      const double least = limits ? limits->at(delay) : 0.0;
      const double before = std::norm(sent) * std::norm(b.amplitude);
      if (limits && points == 0 && before * ring * strongest <= least) continue;
      const ScatterGeometry geometry{.grazing_in = grazing_of(a, a_ends, out.tilt),
                                     .grazing_out = grazing_of(b, b_ends, back.tilt),
                                     .azimuth = turn};
      double* const sigma = &pairs.sigma_[(i * back.paths.size() + j) * (1 + points)];
      if (sigma[0] < 0.0) {
        sigma[0] = cross_section(geometry, ends_.frequency);
        for (std::size_t k = 0; k < points; ++k)
          sigma[k + 1] = cross_section(geometry, ends_.band[k].frequency);
        if (one_place_)  // every law is reciprocal: the same the other way round
          std::copy_n(sigma, 1 + points, &pairs.sigma_[(j * back.paths.size() + i) * (1 + points)]);
      }
      double power = before * sigma[0];
      for (std::size_t k = 0; k < points; ++k) {
        const BandPoint& point = ends_.band[k];
        const std::complex<double> there_and_back =
            a.amplitude * beam(out, i, k + 1) * b.amplitude *
            (std::sqrt(sigma[k + 1]) * std::exp(-point.more_nepers * (a.length + b.length)));
        pairs.colours.push_back(there_and_back);
        power = std::max(power, std::norm(there_and_back));
      }
      if (power <= 0.0 || (limits && power * ring <= least)) {
        pairs.colours.resize(pairs.colours.size() - points);
        continue;
      }
      pairs.found.push_back({.out = &a,
                             .back = &b,
                             .out_index = static_cast<std::uint32_t>(i),
                             .back_index = static_cast<std::uint32_t>(j),
                             .out_ends = &a_ends,
                             .back_ends = &b_ends,
                             .delay = delay,
                             .amplitude = sent * b.amplitude * std::sqrt(sigma[0]),
                             .power = power,
                             .cross_section = sigma[0],
                             .grazing_in = geometry.grazing_in,
                             .grazing_out = geometry.grazing_out,
                             .area = out.tilt ? out.tilt->area : 1.0,
                             .leaving = out.direction,
                             .coming = coming});
    }
  }
}

Vec3 ScatteringSheet::arriving(const PathPair& pair) const noexcept {
  const double level = pair.back_ends->launch_level;
  return {level * pair.coming.x(), level * pair.coming.y(), -pair.back_ends->launch_down};
}

double ScatteringSheet::doppler(const PathPair& pair, const Vec3& velocity,
                                double bragg) const noexcept {
  double factor = 1.0;
  if (moving_) {
    const double level = pair.out_ends->launch_level;
    const Vec3 leaving(level * pair.leaving.x(), level * pair.leaving.y(),
                       pair.out_ends->launch_down);
    factor = (1.0 - ends_.receiver.velocity.dot(arriving(pair))) /
             (1.0 - ends_.source.velocity.dot(leaving));
  }
  const Vec2 in = pair.out->horizontal_slowness * pair.leaving;
  const Vec2 home = pair.back->horizontal_slowness * pair.coming;
  if (!velocity.isZero()) {  // slowness at the scatterer; what came down goes up again
    const Vec3 comes(in.x(), in.y(), pair.out_ends->down);
    const Vec3 goes(home.x(), home.y(), -pair.back_ends->down);
    factor *= (1.0 - velocity.dot(comes)) / (1.0 - velocity.dot(goes));
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
  const DopplerSpan ends =
      ratio(along(ends_.receiver.velocity, back.launch_level, back.launch_down),
            along(ends_.source.velocity, out.launch_level, out.launch_down));
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

double ScatteringSheet::nearest_end(const Vec2& place, double depth) const noexcept {
  const auto distance = [&](const Vec3& end) {
    return std::hypot((place - end.head<2>()).norm(), end.z() - depth);
  };
  return std::min(distance(ends_.source.position), distance(ends_.receiver.position));
}

}  // namespace asdic
