#include "reverb/pairs/scattering_sheet.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "core/doppler.h"
#include "core/mixed_bits.h"
#include "core/propagation_memory.h"
#include "raytrace/parallel/stop.h"
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

Grazing grazing_of(const BoundaryPath& path, const PathEnds& ends,
                   const CellFacet* facet) noexcept {
  if (facet == nullptr) return {path.grazing, ends.sine, ends.cosine};
  const double sine = std::min(1.0, ends.sine * facet->grazing);
  return {std::asin(sine), sine, std::sqrt((1.0 - sine) * (1.0 + sine))};
}

double bundle_draw(std::uint64_t chance, std::size_t bundle) noexcept {
  return uniform_of_bits(mixed(chance, bundle));
}

/// ⁴√σ of sound that comes and goes under one angle, over that angle. A law of the form g(θ_in)·
/// g(θ_out) under its square root is told by it; others are between angles that are near each
/// other.
class BackscatterTable {
 public:
  template <class Law>
  explicit BackscatterTable(const Law& at) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double root = static_cast<double>(i) * step;
      const double angle = std::min(root * root, 0.5 * pi);
      values_[i] = std::sqrt(
          std::sqrt(at(sines_of({.grazing_in = angle, .grazing_out = angle, .azimuth = pi}))));
    }
  }
  [[nodiscard]] double operator()(double grazing) const noexcept {
    const double at = std::sqrt(std::clamp(grazing, 0.0, 0.5 * pi)) / step;
    const auto i = std::min(static_cast<std::size_t>(at), values_.size() - 2);
    return std::lerp(values_[i], values_[i + 1], at - static_cast<double>(i));
  }

 private:
  // Over √θ: near the horizon σ goes like a power of θ.
  static constexpr std::size_t size = 1024;
  static constexpr double step = 1.2534 / (size - 1);  // √(π/2), and a little
  std::array<double, size> values_{};
};

}  // namespace

bool ScatteringSheet::bundled() const noexcept {
  return groups_.out->bundled() || groups_.back->bundled();
}

ScatteringSheet::ScatteringSheet(std::shared_ptr<const BoundaryFan> out,
                                 std::shared_ptr<const BoundaryFan> back, Laws laws,
                                 const SheetEnds& ends, const TransmitPattern& pattern,
                                 Groups groups)
    : out_(std::move(out)),
      back_(std::move(back)),
      groups_(std::move(groups)),
      laws_(std::move(laws)),
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
  const auto add = [&](const Law& law) {
    std::visit(
        [&](const auto& one) {
          auto& at = at_.emplace_back().emplace<std::vector<decltype(one.at(0.0))>>();
          at.push_back(one.at(ends_.frequency));
          for (const BandPoint& point : ends_.band) at.push_back(one.at(point.frequency));
        },
        law);
  };
  add(laws_.usual);
  for (const auto& [kind, law] : laws_.of_kind) {
    add(law);
    kinds_.push_back(kind);
  }
  if (!groups_.out)
    groups_.out = std::make_shared<FanGroups>(*out_, PathResolution{}, ends_.frequency);
  if (!groups_.back)
    groups_.back = out_ == back_
                       ? groups_.out
                       : std::make_shared<FanGroups>(*back_, PathResolution{}, ends_.frequency);
  weigh(Way::out);
  weigh(Way::back);
  if (!azimuthally_symmetric_pattern_) return;
  const auto ask = [&](const TransmitPattern& at) {
    for (const BoundaryPath& path : out_->planes.front().paths->all())
      beam_.push_back(at.towards(0.0, path.launch_elevation));
  };
  ask(pattern_);
  for (const BandPoint& point : ends_.band) ask(*point.pattern);
}

void ScatteringSheet::weigh(Way way) {
  const FanGroups& groups = way == Way::out ? *groups_.out : *groups_.back;
  if (!groups.added()) return;
  const BoundaryFan& fan = way == Way::out ? *out_ : *back_;
  std::vector<BackscatterTable> tables;
  for (const auto& of_law : at_)
    tables.push_back(
        std::visit([](const auto& at) { return BackscatterTable(at.front()); }, of_law));
  std::vector<std::vector<float>>& weights = way == Way::out ? out_weights_ : back_weights_;
  for (std::size_t p = 0; p < fan.planes.size(); ++p) {
    const BoundaryPaths& paths = *fan.planes[p].paths;
    std::vector<float>& of_plane = weights.emplace_back(paths.size(), 1.0F);
    for (std::size_t cell = 0; cell < paths.cells(); ++cell) {
      const std::span<const BoundaryPath> here = paths.paths(cell);
      const auto first = static_cast<std::size_t>(here.data() - paths.all().data());
      const std::vector<CellFacet>& facets = fan.planes[p].facets;
      const BackscatterTable& backscatter =
          tables[law_of(facets.empty() ? nullptr : &facets[cell])];
      for (const PathGroup& group : groups.planes[p].groups(cell)) {
        const double strongest = backscatter(here[group.strongest].grazing);
        if (group.count < 2 || !(strongest > 0.0)) continue;
        for (const std::uint32_t i : groups.planes[p].members(group))
          if (i != group.strongest)
            of_plane[first + i] = static_cast<float>(backscatter(here[i].grazing) / strongest);
      }
    }
  }
}

/// What is sent along a path out. \param point  0: the centre, then those of the band
std::complex<double> ScatteringSheet::beam(const Leg& out, std::size_t path,
                                           std::size_t point) const noexcept {
  if (azimuthally_symmetric_pattern_)
    return beam_[point * out_->planes.front().paths->size() + out.first + path];
  const TransmitPattern& pattern = point == 0 ? pattern_ : *ends_.band[point - 1].pattern;
  return pattern.towards(out.bearing, out.paths[path].launch_elevation);
}

void ScatteringSheet::cross_sections(std::size_t law, const ScatterSines& sines,
                                     double* sigma) const noexcept {
  std::visit(
      [&](const auto& at_frequencies) {
        for (const auto& at : at_frequencies) *sigma++ = at(sines);
      },
      at_[law]);
}

std::size_t ScatteringSheet::law_of(const CellFacet* facet) const noexcept {
  if (facet == nullptr || kinds_.empty()) return 0;
  const auto known = std::lower_bound(kinds_.begin(), kinds_.end(), facet->kind);
  if (known == kinds_.end() || *known != facet->kind) return 0;
  return 1 + static_cast<std::size_t>(known - kinds_.begin());
}

bool ScatteringSheet::azimuthally_symmetric() const noexcept {
  return depends_on_range_alone() &&
         (ends_.source.position - ends_.receiver.position).head<2>().norm() < 1e-3;
}

ScatteringSheet::Leg ScatteringSheet::leg(Way way, const Vec2& end, const Vec2& place,
                                          bool bearing) const noexcept {
  const BoundaryFan& fan = way == Way::out ? *out_ : *back_;
  Leg found;
  const Vec2 towards = place - end;
  const double range = towards.norm();
  found.range = range;
  found.direction = range > 0.0 ? Vec2(towards / range) : Vec2(0.0, 1.0);
  if (bearing || fan.planes.size() > 1)
    found.bearing = std::atan2(found.direction.x(), found.direction.y());
  const FanPlane& plane = fan.towards(found.bearing);
  const BoundaryPaths& paths = *plane.paths;
  const double cells = paths.grid().at(range);
  if (!(cells < static_cast<double>(paths.cells()))) return found;
  const auto cell = static_cast<std::size_t>(cells);
  const auto number = static_cast<std::size_t>(&plane - fan.planes.data());
  found.paths = paths.paths(cell);
  found.grouped = &(way == Way::out ? *groups_.out : *groups_.back).planes[number];
  found.groups = found.grouped->groups(cell);
  found.bundles = found.grouped->bundles(cell);
  found.beyond = range - paths.range(cell);
  if (!plane.facets.empty()) found.facet = &plane.facets[cell];
  found.first = static_cast<std::size_t>(found.paths.data() - paths.all().data());
  found.ends = plane.ends.data() + found.first;
  const auto& weights = way == Way::out ? out_weights_ : back_weights_;
  if (!weights.empty()) found.weights = weights[number].data() + found.first;
  return found;
}

TakenGroup ScatteringSheet::drawn_of(const Leg& leg, std::uint32_t bundle,
                                     std::uint64_t chance) noexcept {
  const DrawnGroup drawn = draw(leg.bundles[bundle], leg.groups, bundle_draw(chance, bundle));
  return {.group = drawn.group, .bundle = bundle, .gain = drawn.gain};
}

void ScatteringSheet::take(const Leg& leg, std::uint64_t chance, std::vector<TakenGroup>& taken) {
  taken.clear();
  if (leg.bundles.empty()) {
    for (std::uint32_t i = 0; i < leg.groups.size(); ++i) taken.push_back({.group = i});
    return;
  }
  for (std::uint32_t b = 0; b < leg.bundles.size(); ++b) {
    if (leg.bundles[b].count == 1)
      taken.push_back({.group = leg.bundles[b].first});
    else
      taken.push_back(drawn_of(leg, b, chance));
  }
}

void ScatteringSheet::sum_up(Way way, const Leg& leg, const TakenGroup& taken, double below,
                             double stretched, std::complex<double>* sums) const noexcept {
  const PathGroup& group = leg.groups[taken.group];
  const std::size_t points = ends_.band.size();
  // A · D, with the absorption of a point of the band.
  const auto pressure = [&](std::uint32_t i, std::size_t point) {
    const BoundaryPath& path = leg.paths[i];
    std::complex<double> p = path.amplitude;
    if (way == Way::out) p *= beam(leg, i, point);
    if (point > 0) p *= std::exp(-ends_.band[point - 1].more_nepers * path.length);
    return p * taken.gain;
  };
  for (std::size_t k = 0; k <= points; ++k) sums[k] = pressure(group.strongest, k);
  if (group.count == 1) return;
  const auto delay_of = [&](std::uint32_t i) {
    return delay_beyond(leg.paths[i], leg.beyond) + leg.ends[i].down * below;
  };
  const double first = delay_of(group.strongest);
  for (const std::uint32_t i : leg.grouped->members(group)) {
    if (i == group.strongest) continue;
    const double later = stretched * (delay_of(i) - first);
    const double weight = double(leg.weights[i]);
    for (std::size_t k = 0; k <= points; ++k) {
      const double f = k == 0 ? ends_.frequency : ends_.band[k - 1].frequency;
      sums[k] += weight * pressure(i, k) * std::polar(1.0, -2.0 * pi * f * later);
    }
  }
}

double ScatteringSheet::most_shift(const Leg& back, double delay) const noexcept {
  if (!ends_.legs.empty()) return infinity;
  if (!receiver_moves_) return 0.0;
  constexpr double slowest = 1.0 / 1000.0;  // [s/m] no path is slower
  const double speed = ends_.receiver.velocity.norm(), ratio = speed * slowest;
  if (ratio > 0.1) return infinity;
  const double straight = 2.0 * ratio * delay / (1.0 - 2.0 * ratio), later = delay + straight;
  return straight +
         0.5 * later * (slowest * speed * speed / std::max(1.0, back.range) * later + 0.2 * ratio);
}

void ScatteringSheet::pairs_at(const Vec2& place, PathPairs& pairs, const AudibleLimits* limits,
                               double ring, double below, std::uint64_t chance) const {
  stop_point();                      // who asks at a place asks at thousands
  constexpr double strongest = 2.0;  // [1/sr] no law says more
  pairs.found.clear();
  pairs.responses.clear();
  const std::size_t points = ends_.band.size();
  const Leg out =
      leg(Way::out, ends_.source.position.head<2>(), place, !azimuthally_symmetric_pattern_);
  if (out.paths.empty()) return;
  const Vec2 receiver = ends_.receiver.position.head<2>();
  Leg back = one_place_ ? out : leg(Way::back, receiver, place, false);
  if (back.paths.empty()) return;
  // Where the receiver is when the first path is received: all others are received metres from
  // there.
  double received = 0.0;
  if (receiver_moves_) {
    received = out.paths.front().delay + back.paths.front().delay;
    back = leg(Way::back, ends_.receiver_at(received).head<2>(), place, false);
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
  take(out, chance, pairs.out_taken_);
  // In one cell the same groups stand for the bundles of both ways: reciprocal pairs meet.
  take(back, one_cell ? chance : ~chance, pairs.back_taken_);
  const std::size_t outs = pairs.out_taken_.size(), backs = pairs.back_taken_.size();
  const std::size_t law = law_of(out.facet);
  if (drawn || out.facet || back.facet || pairs.sheet_ != this || pairs.out_ != out.first ||
      pairs.back_ != back.first || std::abs(pairs.turn_ - turn) > same_turn ||
      pairs.sigma_.size() != outs * backs * (1 + points)) {
    pairs.sheet_ = this;
    pairs.out_ = out.first;
    pairs.back_ = back.first;
    pairs.turn_ = turn;
    pairs.sigma_.assign(outs * backs * (1 + points), -1.0);
  }
  // Differences of delay are those of a source that lies still: the pulse is stretched as it goes.
  const PathEnds& leaving = out.ends[out.groups[pairs.out_taken_.front().group].strongest];
  const Vec3 way(leaving.launch_level * out.direction.x(), leaving.launch_level * out.direction.y(),
                 leaving.launch_down);
  const double stretched = 1.0 / (1.0 - ends_.source.velocity.dot(way));
  const auto sum_all = [&](Way leg_way, const Leg& leg, std::span<const TakenGroup> taken,
                           std::vector<std::complex<double>>& sums) {
    sums.resize(taken.size() * (1 + points));
    for (std::size_t t = 0; t < taken.size(); ++t)
      sum_up(leg_way, leg, taken[t], below, stretched, &sums[t * (1 + points)]);
  };
  sum_all(Way::out, out, pairs.out_taken_, pairs.sent_);
  sum_all(Way::back, back, pairs.back_taken_, pairs.home_);
  pairs.way_home_.resize(backs);
  pairs.power_home_.resize(backs);
  double longest = 0.0;
  for (std::size_t n = 0; n < backs; ++n) {
    const std::size_t j = back.groups[pairs.back_taken_[n].group].strongest;
    pairs.way_home_[n] = delay_beyond(back.paths[j], back.beyond) + back.ends[j].down * below;
    pairs.power_home_[n] = std::norm(pairs.home_[n * (1 + points)]);
    longest = std::max(longest, pairs.way_home_[n]);
  }
  for (std::size_t m = 0; m < outs; ++m) {
    const TakenGroup& first = pairs.out_taken_[m];
    const std::size_t i = out.groups[first.group].strongest;
    const BoundaryPath& a = out.paths[i];
    const PathEnds& a_ends = out.ends[i];
    const std::complex<double>* const sent = &pairs.sent_[m * (1 + points)];
    if (sent[0] == 0.0 && points == 0) continue;
    std::optional<Grazing> grazing_in;  // once it is asked for
    const double there = delay_beyond(a, out.beyond) + a_ends.down * below;
    const double sent_power = std::norm(sent[0]);
    // Most pairs are too faint whenever they are received, and need not be known closer.
    constexpr double far = 32.0;  // segments: beyond, to look is as long as to know
    const double shift =
        limits && points == 0
            ? most_shift(back, std::max(received, there + longest)) / (0.99 * limits->segment)
            : infinity;
    const bool in_a_glance = shift < far;
    const auto segments = in_a_glance ? static_cast<std::size_t>(shift) + 1 : 0;
    for (std::size_t n = 0; n < backs; ++n) {
      // Pairs within a bundle are those of two draws: that of a group with itself is one of many.
      const TakenGroup& other = pairs.back_taken_[n];
      const bool of_many = first.of_many() || other.of_many();
      const bool one_bundle = of_many && one_cell && first.bundle == other.bundle;
      if (in_a_glance && !one_bundle &&
          sent_power * pairs.power_home_[n] * ring * strongest <=
              limits->about(there + pairs.way_home_[n], segments))
        continue;
      const std::complex<double>* home = &pairs.home_[n * (1 + points)];
      TakenGroup second = other;
      if (one_bundle) {
        second = drawn_of(back, first.bundle, ~chance);
        pairs.other_home_.resize(1 + points);
        sum_up(Way::back, back, second, below, stretched, pairs.other_home_.data());
        home = pairs.other_home_.data();
      }
      const std::size_t j = back.groups[second.group].strongest;
      const BoundaryPath& b = back.paths[j];
      const PathEnds& b_ends = back.ends[j];
      double delay = there + (one_bundle ? delay_beyond(b, back.beyond) + b_ends.down * below
                                         : pairs.way_home_[n]);
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
      // A group of a bundle with another of it is received twice where its reciprocal is in phase.
      const bool twice = one_bundle && in_phase_ && i != j;
      const double gain = twice ? std::sqrt(2.0) : 1.0;
      const double before = sent_power * std::norm(home[0]) * gain * gain;
      if (limits && points == 0 && before * ring * strongest <= least) continue;
      if (!grazing_in) grazing_in = grazing_of(a, a_ends, out.facet);
      const Grazing grazing_out = grazing_of(b, b_ends, back.facet);
      double* const sigma = &pairs.sigma_[(m * backs + n) * (1 + points)];
      if (sigma[0] < 0.0) {
        cross_sections(law,
                       {.angles = {.grazing_in = grazing_in->angle,
                                   .grazing_out = grazing_out.angle,
                                   .azimuth = turn},
                        .sin_in = grazing_in->sine,
                        .cos_in = grazing_in->cosine,
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
        const std::complex<double> there_and_back =
            sent[k + 1] * home[k + 1] * (gain * std::sqrt(sigma[k + 1]));
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
                             .amplitude = sent[0] * home[0] * (std::sqrt(sigma[0]) * gain),
                             .power = power,
                             .cross_section = sigma[0],
                             .grazing_in = grazing_in->angle,
                             .grazing_out = grazing_out.angle,
                             .area = out.facet ? out.facet->area : 1.0,
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

namespace {

/// Lobe about the mirrored direction, in tilts of the facets that mirror.
struct Lobe {
  double step = infinity;  ///< over which it is nearly even
  double reach = 0.0;      ///< beyond which it is nothing
};

/// Lobe of all laws together: of slopes of 0.06 to 0.2 of a sea, or as the floor's law has it.
Lobe lobe_of(const ScatteringLaws& laws) {
  Lobe all;
  const auto add = [&](const AnyScattering& law) {
    Lobe one;
    if (std::holds_alternative<NrlSurface>(law)) one = {.step = 0.15, .reach = 0.5};
    if (const auto* floor = std::get_if<EllisCrowe>(&law)) {
      const double slope = std::tan(radians(floor->slope_deg));
      one = {.step = 1.5 * slope, .reach = 5.0 * slope};
    }
    all = {.step = std::min(all.step, one.step), .reach = std::max(all.reach, one.reach)};
  };
  add(laws.usual);
  for (const auto& [kind, law] : laws.of_kind) add(law);
  return all;
}

}  // namespace

double ScatteringSheet::largest_piece(const Vec2& place, double depth, double size) const noexcept {
  constexpr double finest = 1.0 / 256.0;  // of the distance from the nearer end
  const Lobe lobe = lobe_of(laws_);
  if (!(lobe.reach > 0.0)) return infinity;
  const auto from_place = [&](const Vec3& end) {
    return Vec3(end.x() - place.x(), end.y() - place.y(), end.z() - depth);
  };
  const Vec3 out = from_place(ends_.source.position), back = from_place(ends_.receiver.position);
  const double r1 = std::max(out.norm(), 1e-3), r2 = std::max(back.norm(), 1e-3);
  // Straight lines: half of both directions' sum is a facet's normal, which a way y along the
  // ground tilts by y (1/r₁ + 1/r₂) over the vertical part of the sum.
  const Vec3 normal = out / r1 + back / r2;
  const double upright = std::abs(normal.z()), by_metre = 1.0 / r1 + 1.0 / r2;
  const double tilted = normal.head<2>().norm() - 0.5 * size * by_metre;
  if (tilted > lobe.reach * upright) return infinity;
  return std::max(lobe.step * upright / by_metre, finest * std::min(r1, r2));
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

namespace {

void add(ExactKey& key, const Kinematics& end) {
  const auto& [position, velocity] = end;
  key.add_all(position, velocity);
}

}  // namespace

bool ScatteringSheet::add_to(ExactKey& key) const {
  key.add_all(out_->identity, back_->identity, laws_.usual, laws_.of_kind.size());
  for (const auto& [kind, law] : laws_.of_kind) key.add_all(kind, law);
  const auto& [source, receiver, legs, source_speed, receiver_speed, frequency, latest, band] =
      ends_;
  for (const auto& groups : {groups_.out, groups_.back}) {
    const auto& [delay, level, level_of_range, depth, thickness] = groups->resolution;
    key.add_all(delay, level, level_of_range, depth, thickness);
  }
  add(key, source);
  add(key, receiver);
  key.add_all(source_speed, receiver_speed, frequency, latest, band.size(), legs.size());
  for (const auto& [until, line] : legs) {
    key.add(until);
    add(key, line);
  }
  bool all = pattern_.add_to(key);
  for (const auto& [at, pattern, more_nepers] : band) {
    key.add_all(at, more_nepers);
    all = pattern->add_to(key) && all;
  }
  return all;
}

}  // namespace asdic::detail
