#include "reverb/scattering_sheet.h"

#include <algorithm>

#include <algorithm>
#include <numbers>
#include "raytrace/parallel/stop.h"
#include "reverb/uniform_of_bits.h"

#include "core/doppler.h"
#include "reverb/scattering/motion.h"

namespace asdic::detail {

namespace {

/// From a cell's centre on: the delay's Taylor series to the second order, whose last term is held
/// where a caustic makes it large.
double delay_beyond(const BoundaryPath& path, double beyond) noexcept {
  const double bend = std::clamp(0.5 * path.slowness_slope * beyond,
                                 -0.1 * path.horizontal_slowness, 0.1 * path.horizontal_slowness);
  return path.delay + (path.horizontal_slowness + bend) * beyond;
}

/// The angle between a path and the boundary itself.
struct Grazing {
  double angle, sine, cosine;
};

Grazing grazing_of(const BoundaryPath& path, const PathEnds& ends, const CellTilt* tilt) noexcept {
  if (tilt == nullptr) return {path.grazing, ends.sine, ends.cosine};
  const double sine = std::min(1.0, ends.sine * tilt->grazing);
  return {std::asin(sine), sine, std::sqrt((1.0 - sine) * (1.0 + sine))};
}

double bundle_draw(std::uint64_t chance, std::size_t bundle) noexcept {
  return uniform_of_bits(mixed(chance, bundle));
}

TakenPath drawn_of(std::span<const BoundaryPath> paths, const PathBundle& bundle,
                   std::uint32_t index, double uniform) noexcept {
  const DrawnPath drawn = draw(bundle, paths, uniform);
  const double own = std::norm(paths[drawn.path].amplitude);
  return {
      .path = drawn.path, .bundle = index, .gain = own > 0.0 ? std::sqrt(drawn.power / own) : 0.0};
}

/// The paths of a cell that are followed: all, or one of each bundle.
void take(std::span<const BoundaryPath> paths, std::span<const PathBundle> bundles,
          std::uint64_t chance, std::vector<TakenPath>& taken) {
  taken.clear();
  if (bundles.empty()) {
    for (std::uint32_t i = 0; i < paths.size(); ++i) taken.push_back({.path = i});
    return;
  }
  for (std::uint32_t b = 0; b < bundles.size(); ++b) {
    if (bundles[b].count == 1)
      taken.push_back({.path = bundles[b].first});
    else if (bundles[b].power > 0.0)
      taken.push_back(drawn_of(paths, bundles[b], b, bundle_draw(chance, b)));
  }
}

}  // namespace

bool ScatteringSheet::bundled() const noexcept {
  const auto has = [](const BoundaryFan& fan) {
    return std::any_of(fan.planes.begin(), fan.planes.end(),
                       [](const FanPlane& plane) { return plane.paths->bundled(); });
  };
  return has(*out_) || has(*back_);
}

ScatteringSheet::ScatteringSheet(std::shared_ptr<const BoundaryFan> out,
                                 std::shared_ptr<const BoundaryFan> back, Law law,
                                 const SheetEnds& ends, const TransmitPattern& pattern)
    : out_(std::move(out)),
      back_(std::move(back)),
      law_(std::move(law)),
      ends_(ends),
      pattern_(pattern),
      azimuthally_symmetric_pattern_(pattern.azimuthally_symmetric() && out_->planes.size() == 1),
      receiver_moves_(ends.receiver_moves()),
      moving_(receiver_moves_ || !ends.source.velocity.isZero()),
      one_place_(out_ == back_ && !receiver_moves_ &&
                 ends.source.position == ends.receiver.position),
      in_phase_(out_ == back_ && !receiver_moves_ &&
                (ends.source.position - ends.receiver.position).norm() * ends.frequency <
                    0.25 * ends.source_speed) {
  std::visit(
      [&](const auto& one) {
        auto& at = at_.emplace<std::vector<decltype(one.at(0.0))>>();
        at.push_back(one.at(ends_.frequency));
        for (const BandPoint& point : ends_.band) at.push_back(one.at(point.frequency));
      },
      law_);
  if (!azimuthally_symmetric_pattern_) return;
  const auto ask = [&](const TransmitPattern& at) {
    for (const BoundaryPath& path : out_->planes.front().paths->all())
      beam_.push_back(at.towards(0.0, path.launch_elevation));
  };
  ask(pattern_);
  for (const BandPoint& point : ends_.band) ask(*point.pattern);
}

/// What is sent along a path out. \param point  0: the centre, then those of the band
std::complex<double> ScatteringSheet::beam(const Leg& out, std::size_t path,
                                           std::size_t point) const noexcept {
  if (azimuthally_symmetric_pattern_)
    return beam_[point * out_->planes.front().paths->size() + out.first + path];
  const TransmitPattern& pattern = point == 0 ? pattern_ : *ends_.band[point - 1].pattern;
  return pattern.towards(out.bearing, out.paths[path].launch_elevation);
}

void ScatteringSheet::cross_sections(const ScatterSines& sines, double* sigma) const noexcept {
  std::visit(
      [&](const auto& law) {
        for (const auto& at : law) *sigma++ = at(sines);
      },
      at_);
}

bool ScatteringSheet::azimuthally_symmetric() const noexcept {
  return azimuthally_symmetric_pattern_ && back_->planes.size() == 1 &&
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
  const BoundaryPaths& paths = *plane.paths;
  const double cells = paths.grid().at(range);
  if (!(cells < static_cast<double>(paths.cells()))) return found;
  const auto cell = static_cast<std::size_t>(cells);
  found.paths = paths.paths(cell);
  found.bundles = paths.bundles(cell);
  found.beyond = range - paths.range(cell);
  if (!plane.tilt.empty()) found.tilt = &plane.tilt[cell];
  found.first = static_cast<std::size_t>(found.paths.data() - paths.all().data());
  found.ends = plane.ends.data() + found.first;
  return found;
}

void ScatteringSheet::pairs_at(const Vec2& place, PathPairs& pairs, const AudibleLimits* limits,
                               double ring, double below, std::uint64_t chance) const {
  stop_point();                      // who asks at a place asks at thousands
  constexpr double strongest = 2.0;  // [1/sr] no law says more
  pairs.found.clear();
  pairs.responses.clear();
  const std::size_t points = ends_.band.size();
  const Leg out =
      leg(*out_, ends_.source.position.head<2>(), place, !azimuthally_symmetric_pattern_);
  if (out.paths.empty()) return;
  const Vec2 receiver = ends_.receiver.position.head<2>();
  Leg back = one_place_ ? out : leg(*back_, receiver, place, false);
  if (back.paths.empty()) return;
  // Where the receiver is when the first path is received: all others are received metres from
  // there.
  double received = 0.0;
  if (receiver_moves_) {
    received = out.paths.front().delay + back.paths.front().delay;
    back = leg(*back_, ends_.receiver_at(received).head<2>(), place, false);
    if (back.paths.empty()) return;
  }
  const Vec2 coming = -back.direction;
  // Towards the scatterer [m/s]: the way back shrinks by closing·(t − received).
  const double closing = ends_.receiver.velocity.head<2>().dot(back.direction);
  const double sinking = ends_.receiver.velocity.z();
  const double across2 =  // v² across the way over its length: how fast the way bends [m/s²]
      (ends_.receiver.velocity.head<2>().squaredNorm() - closing * closing) /
      std::max(1.0, back.range);
  const double turn = one_place_ ? pi : std::acos(std::clamp(out.direction.dot(coming), -1.0, 1.0));
  const double half_turn = one_place_ ? 1.0 : std::sin(0.5 * turn);
  constexpr double same_turn = 1e-6;  // [rad]
  const bool one_cell = one_fan() && out.first == back.first;
  const bool drawn = !out.bundles.empty() || !back.bundles.empty();
  take(out.paths, out.bundles, chance, pairs.out_taken_);
  // In one cell the same paths stand for the bundles of both ways: reciprocal pairs meet.
  take(back.paths, back.bundles, one_cell ? chance : ~chance, pairs.back_taken_);
  const std::size_t outs = pairs.out_taken_.size(), backs = pairs.back_taken_.size();
  if (drawn || out.tilt || back.tilt || pairs.sheet_ != this || pairs.out_ != out.first ||
      pairs.back_ != back.first || std::abs(pairs.turn_ - turn) > same_turn ||
      pairs.sigma_.size() != outs * backs * (1 + points)) {
    pairs.sheet_ = this;
    pairs.out_ = out.first;
    pairs.back_ = back.first;
    pairs.turn_ = turn;
    pairs.sigma_.assign(outs * backs * (1 + points), -1.0);
  }
  for (std::size_t m = 0; m < outs; ++m) {
    const TakenPath& first = pairs.out_taken_[m];
    const std::size_t i = first.path;
    const BoundaryPath& a = out.paths[i];
    const PathEnds& a_ends = out.ends[i];
    const std::complex<double> sent = a.amplitude * beam(out, i, 0) * first.gain;
    if (sent == 0.0 && points == 0) continue;
    const Grazing grazing_in = grazing_of(a, a_ends, out.tilt);
    const double there = delay_beyond(a, out.beyond) + a_ends.down * below;
    for (std::size_t n = 0; n < backs; ++n) {
      // Pairs within a bundle are those of two draws: that of a path with itself is one of many.
      const TakenPath& other = pairs.back_taken_[n];
      const bool of_many = first.of_many() || other.of_many();
      const bool one_bundle = of_many && one_cell && first.bundle == other.bundle;
      const TakenPath second = one_bundle
                                   ? drawn_of(back.paths, back.bundles[first.bundle], first.bundle,
                                              bundle_draw(~chance, first.bundle))
                                   : other;
      const std::size_t j = second.path;
      const BoundaryPath& b = back.paths[j];
      const PathEnds& b_ends = back.ends[j];
      double delay = there + delay_beyond(b, back.beyond) + b_ends.down * below;
      const Kinematics* on = &ends_.receiver;
      if (!ends_.legs.empty()) {
        const Reception reception = received_under_way(back, j, received, delay);
        delay = reception.delay;
        on = reception.receiver;
      } else if (receiver_moves_) {
        // t = τ_out + τ_back − ξ·closing·(t − received) + s_z·v_z·t, solved for t. The sound
        // arrives against the direction in which b was launched: s_z is minus its vertical
        // slowness.
        const double along = b.horizontal_slowness * closing;
        const double down = -b_ends.launch_down * sinking;
        delay = (delay + along * received) / (1.0 + along - down);
        // What is not linear: the way bends, and the slowness changes along it.
        const double later = delay - received, held = 0.2 * b.horizontal_slowness;
        const double bend = std::clamp(b.slowness_slope * closing * later, -held, held);
        delay += 0.5 * later * (b.horizontal_slowness * across2 * later + bend * closing);
      }
      if (delay > ends_.latest) continue;
      const double least = limits ? limits->at(delay) : 0.0;
      // A path of a bundle with another of it is received twice where its reciprocal is in phase.
      const bool twice = one_bundle && in_phase_ && i != j;
      const double gain = twice ? second.gain * std::sqrt(2.0) : second.gain;
      const double before = std::norm(sent) * std::norm(b.amplitude) * gain * gain;
      if (limits && points == 0 && before * ring * strongest <= least) continue;
      const Grazing grazing_out = grazing_of(b, b_ends, back.tilt);
      double* const sigma = &pairs.sigma_[(m * backs + n) * (1 + points)];
      if (sigma[0] < 0.0) {
        cross_sections({.angles = {.grazing_in = grazing_in.angle,
                                   .grazing_out = grazing_out.angle,
                                   .azimuth = turn},
                        .sin_in = grazing_in.sine,
                        .cos_in = grazing_in.cosine,
                        .sin_out = grazing_out.sine,
                        .cos_out = grazing_out.cosine,
                        .half_turn = half_turn},
                       sigma);
        // Every law is reciprocal: at one place the same the other way round.
        double* const reciprocal =
            one_place_ ? &pairs.sigma_[(n * backs + m) * (1 + points)] : sigma;
        for (std::size_t k = 0; k <= points; ++k) reciprocal[k] = sigma[k];
      }
      double power = before * sigma[0];
      for (std::size_t k = 0; k < points; ++k) {
        const BandPoint& point = ends_.band[k];
        const std::complex<double> there_and_back =
            a.amplitude * beam(out, i, k + 1) * b.amplitude *
            (first.gain * gain * std::sqrt(sigma[k + 1]) *
             std::exp(-point.more_nepers * (a.length + b.length)));
        pairs.responses.push_back(there_and_back);
        power = std::max(power, std::norm(there_and_back));
      }
      if (power <= 0.0 || (limits && power * ring <= least)) {
        pairs.responses.resize(pairs.responses.size() - points);
        continue;
      }
      pairs.found.push_back({.out = &a,
                             .back = &b,
                             .out_index = static_cast<std::uint32_t>(i),
                             .back_index = static_cast<std::uint32_t>(j),
                             .out_ends = &a_ends,
                             .back_ends = &b_ends,
                             .delay = delay,
                             .amplitude = sent * b.amplitude * (std::sqrt(sigma[0]) * gain),
                             .power = power,
                             .cross_section = sigma[0],
                             .grazing_in = grazing_in.angle,
                             .grazing_out = grazing_out.angle,
                             .area = out.tilt ? out.tilt->area : 1.0,
                             .leaving = out.direction,
                             .coming = coming,
                             .receiver = on,
                             .of_many = of_many,
                             .reciprocal = of_many && in_phase_ && one_cell && m != n ? 2.0 : 1.0});
    }
  }
}

/// Solves (2) on the leg on which it is received. Tables are read where the receiver is at
/// `received`; a leg that it takes at another time passes beside there, and the way back changes by
/// −n·d + |d − (n·d)n|²/2r for its place d from there on. \param unmoved  delay to that place [s]
ScatteringSheet::Reception ScatteringSheet::received_under_way(const Leg& back, std::size_t path,
                                                               double received,
                                                               double unmoved) const noexcept {
  const BoundaryPath& b = back.paths[path];
  const double rising = -back.ends[path].launch_down;  // s_z of the sound, which comes against it
  const Vec3 there = ends_.receiver_at(received);
  Reception found{.delay = unmoved};
  constexpr int most = 4;  // at a turn, two legs may each send to the other: microseconds
  for (int i = 0; i < most; ++i) {
    const Kinematics& line = leg_at(ends_.legs, found.delay).line;
    if (&line == found.receiver) break;
    found.receiver = &line;
    const Vec2 velocity = line.velocity.head<2>();
    const Vec2 beside = (line.position - there).head<2>() + velocity * received;
    const double deeper = line.position.z() - ends_.receiver.position.z();
    const double along = b.horizontal_slowness * velocity.dot(back.direction);
    const double t = (unmoved - b.horizontal_slowness * beside.dot(back.direction) +
                      along * received + rising * deeper) /
                     (1.0 + along - rising * line.velocity.z());
    const Vec2 moved = beside + velocity * (t - received);
    const double closer = moved.dot(back.direction);
    const double held = 0.2 * b.horizontal_slowness;
    const double bend = std::clamp(b.slowness_slope * closer, -held, held);
    const double across2 = moved.squaredNorm() - closer * closer;
    found.delay =
        t + 0.5 * (b.horizontal_slowness * across2 / std::max(1.0, back.range) + bend * closer);
  }
  return found;
}

double ScatteringSheet::nearest_end(const Vec2& place, double depth) const noexcept {
  const auto distance = [&](const Vec3& end) {
    return std::hypot((place - end.head<2>()).norm(), end.z() - depth);
  };
  return std::min(distance(ends_.source.position), distance(ends_.receiver.position));
}

Vec3 ScatteringSheet::arriving(const PathPair& pair) const noexcept {
  const double level = pair.back_ends->launch_level;
  return {level * pair.coming.x(), level * pair.coming.y(), -pair.back_ends->launch_down};
}

double ScatteringSheet::fastest_ends() const noexcept {
  double received = ends_.receiver.velocity.norm();
  for (const ReceiverLeg& leg : ends_.legs) received = std::max(received, leg.line.velocity.norm());
  return ends_.source.velocity.norm() + received;
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
    for (const BoundaryPath& path : plane.paths->all()) {
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
  double received = along(ends_.receiver.velocity, back.launch_level, back.launch_down);
  for (const ReceiverLeg& leg : ends_.legs)
    received = std::max(received, along(leg.line.velocity, back.launch_level, back.launch_down));
  const DopplerSpan ends =
      ratio(received, along(ends_.source.velocity, out.launch_level, out.launch_down));
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

}  // namespace asdic::detail
