#include "sonar/heard_places.h"

#include <algorithm>
#include <cmath>

#include "sonar/moving_paths.h"
#include "sonar/phase_turn.h"

namespace asdic {
namespace {

/// The pair that takes the same two paths the other way round, if it is another one.
const PathPair* reciprocal(const PathPairs& pairs, const PathPair& pair) noexcept {
  for (const PathPair& other : pairs.found)
    if (other.out == pair.back && other.back == pair.out && &other != &pair) return &other;
  return nullptr;
}

/// ∂delay over the ground, towards a direction [s/m].
double steepness(const PathPair& pair, const Vec2& towards) noexcept {
  return pair.out->horizontal_slowness * pair.leaving.dot(towards) -
         pair.back->horizontal_slowness * pair.coming.dot(towards);
}

/// Variance of what is even over a width.
double square_of_even(double width) noexcept { return width * width / 12.0; }

/// How far two sounds of one place are in phase: 2·Re⟨p_a p_b*⟩, a mean over the piece of ground,
/// the phones and the pulse.
class Between {
 public:
  Between(const PathInterference& interference, double omega, const Ground& ground,
          double thickness, double strongest)
      : interference_(interference),
        strongest_(strongest),
        along2_(square_of_even(omega * ground.length)),
        across2_(square_of_even(omega * ground.width)),
        through2_(square_of_even(omega * thickness)),
        doppler2_(square_of_even(omega * std::min(1e6, interference.pulse().duration()))) {}

  [[nodiscard]] double operator()(const PlaceSound& a, const PlaceSound& b) const noexcept {
    constexpr double nothing = 9.0;  // 1 % of their product
    constexpr double faint = 1e-8;   // of the strongest's power squared
    if (std::norm(a.amplitude) * std::norm(b.amplitude) < faint * strongest_ * strongest_)
      return 0.0;
    const auto squared = [](double x) { return x * x; };
    const double turns =
        along2_ * squared(a.along - b.along) + across2_ * squared(a.across - b.across) +
        through2_ * squared(a.through - b.through) + doppler2_ * squared(a.doppler - b.doppler);
    if (!(turns < nothing)) return 0.0;
    const std::complex<double> heard = interference_.over_phones(a.slowness - b.slowness) *
                                       interference_.pulse()(b.delay - a.delay);
    return 2.0 * std::exp(-0.5 * turns) * (a.amplitude * std::conj(b.amplitude) * heard).real();
  }

 private:
  const PathInterference& interference_;
  double strongest_;  // power of a sound
  double along2_, across2_, through2_, doppler2_;
};

/// Puts interference between the sounds of a place into the powers of what is heard of it.
void interfere(const Between& between, double lasting, HearingMemory& memory,
               std::span<Heard> heard) {
  constexpr std::size_t most = 64;  // sounds; weaker ones add by energy
  std::vector<PlaceSound>& sounds = memory.sounds;
  const auto strength = [](const PlaceSound& s) { return std::norm(s.amplitude); };
  if (sounds.size() > most) {
    std::nth_element(
        sounds.begin(), sounds.begin() + most, sounds.end(),
        [&](const PlaceSound& a, const PlaceSound& b) { return strength(a) > strength(b); });
    sounds.resize(most);
  }
  std::sort(sounds.begin(), sounds.end(),
            [](const PlaceSound& a, const PlaceSound& b) { return a.delay < b.delay; });
  memory.power.assign(heard.size(), 0.0);
  memory.between.assign(heard.size(), 0.0);
  for (std::size_t i = 0; i < sounds.size(); ++i) {
    const PlaceSound& a = sounds[i];
    memory.power[a.heard] += strength(a);
    for (std::size_t j = i + 1; j < sounds.size(); ++j) {
      const PlaceSound& b = sounds[j];
      if (b.delay - a.delay >= lasting) break;
      const double both = between(a, b);
      if (a.heard == b.heard) {  // its two directions have this in their covariance
        memory.power[a.heard] += both;
        continue;
      }
      memory.between[a.heard] += 0.5 * both;
      memory.between[b.heard] += 0.5 * both;
    }
  }
  // The sum over sounds that overlap is a power, and not below 0; the share of one may be.
  for (std::size_t begin = 0, end = 0; begin < sounds.size(); begin = end) {
    double all = 0.0, positive = 0.0;
    const auto each = [&](auto&& of_one) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t u = sounds[i].heard;
        const bool met = std::any_of(sounds.begin() + static_cast<std::ptrdiff_t>(begin),
                                     sounds.begin() + static_cast<std::ptrdiff_t>(i),
                                     [u](const PlaceSound& s) { return s.heard == u; });
        if (!met) of_one(u, memory.power[u] + memory.between[u]);
      }
    };
    end = begin + 1;
    while (end < sounds.size() && sounds[end].delay - sounds[end - 1].delay < lasting) ++end;
    each([&](std::size_t, double power) {
      all += power;
      positive += std::max(0.0, power);
    });
    const double share = positive > 0.0 ? std::max(0.0, all) / positive : 0.0;
    each([&](std::size_t u, double power) {
      const double own = memory.power[u];
      const double gain = own > 0.0 ? std::sqrt(std::max(0.0, power) * share / own) : 1.0;
      heard[u].one *= gain;
      heard[u].other *= gain;
    });
  }
}

}  // namespace

PathInterference::PathInterference(std::span<const Vec3> phones, double frequency,
                                   const PulseCoherence& pulse, bool all_round)
    : pulse_(pulse), frequency_(frequency) {
  double level = 0.0;
  for (const Vec3& x : phones) {
    phones_.emplace_back(frequency * x);
    level = std::max(level, phones_.back().head<2>().norm());
    reach_ = std::max(reach_, phones_.back().norm());
  }
  if (all_round) bessel_.emplace(2.0 * pi * level * 2.0 / slowest_sea + 1.0);
}

std::complex<double> PathInterference::over_phones(const Vec3& apart) const noexcept {
  constexpr double alike = 1e-3;  // [rad]
  if (2.0 * pi * apart.norm() * reach_ < alike) return 1.0;
  double re = 0.0, im = 0.0;
  if (bessel_) {
    const double level = 2.0 * pi * apart.head<2>().norm();
    for (const Vec3& x : phones_) {
      double one = (*bessel_)(level * x.head<2>().norm()), other = 0.0;
      turn_back(apart.z() * x.z(), one, other);
      re += one;
      im += other;
    }
  } else {
    for (const Vec3& x : phones_) {
      double one = 1.0, other = 0.0;
      turn_back(apart.dot(x), one, other);
      re += one;
      im += other;
    }
  }
  return std::complex<double>(re, im) / static_cast<double>(phones_.size());
}

void hear(const ScatteringField& field, const Ground& ground, const AudibleLimits& limits,
          const PathInterference& interference, bool all_round, HearingMemory& memory,
          std::vector<Heard>& heard) {
  constexpr double in_phase = 3.0;  // [rad] further apart, two sounds are none together
  const ScatteringSheet& sheet = field.sheet;
  const ScattererMotion& motion = field.field.motion;
  const Vec3 drift(motion.current.x(), motion.current.y(), 0.0);
  const double omega = 2.0 * pi * sheet.ends().frequency;
  const Vec2 beside(-ground.outward.y(), ground.outward.x());
  PathPairs& pairs = memory.pairs;
  sheet.pairs_at(ground.middle, pairs, &limits, ground.ring, 0.0, ground.chance);
  memory.sounds.clear();
  memory.by.clear();
  const std::size_t first = heard.size();
  const auto put = [&](const PathPair& pair, const std::complex<double>& amplitude,
                       const Vec3& slowness, double doppler) {
    if (pair.of_many) return;  // by energy
    double re = amplitude.real(), im = amplitude.imag();
    turn_back(sheet.ends().frequency * (pair.delay - pairs.found.front().delay), re, im);
    memory.sounds.push_back({.amplitude = {re, im},
                             .delay = pair.delay,
                             .along = steepness(pair, ground.outward),
                             .across = steepness(pair, beside),
                             .through = pair.out_ends->down + pair.back_ends->down,
                             .doppler = doppler,
                             .slowness = slowness,
                             .heard = heard.size() - first});
  };
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
    const double along = steepness(pair, ground.outward);
    const double through = pair.out_ends->down + pair.back_ends->down;
    Heard h{.delay = pair.delay,
            .extent = std::abs(along) * ground.length + std::abs(through) * field.thickness,
            .one = root * pair.amplitude,
            .one_slowness = met_by(pair.receiver->velocity, sheet.arriving(pair)),
            .one_length = pair.back->length,
            .doppler = sheet.doppler(pair, drift, 0.0),
            .all_round = all_round};
    put(pair, h.one, h.one_slowness, h.doppler);
    if (other != nullptr) {
      h.other = root * other->amplitude * std::polar(1.0, -turn);
      h.other_slowness = met_by(other->receiver->velocity, sheet.arriving(*other));
      h.other_length = other->back->length;
      put(*other, root * other->amplitude, h.other_slowness, h.doppler);
    }
    heard.push_back(h);
    memory.by.push_back(&pair);
  }
  double strongest = 0.0;
  for (const PlaceSound& sound : memory.sounds)
    strongest = std::max(strongest, std::norm(sound.amplitude));
  if (memory.sounds.size() > 1)
    interfere(Between(interference, omega, ground, field.thickness, strongest),
              interference.pulse().duration(), memory, std::span(heard).subspan(first));
  if (motion.kind != ScattererMotion::Kind::bragg) return;
  // By waves that come and by those that go: two lines.
  for (std::size_t i = 0; i < memory.by.size(); ++i) {
    Heard goes = heard[first + i];
    const auto line = [&](Heard& h, double bragg, double share) {
      h.doppler = sheet.doppler(*memory.by[i], drift, bragg);
      h.one *= std::sqrt(share);
      h.other *= std::sqrt(share);
    };
    line(goes, -1.0, motion.receding_share);
    line(heard[first + i], 1.0, 1.0 - motion.receding_share);
    if (motion.receding_share > 0.0) heard.push_back(goes);
  }
}

}  // namespace asdic
