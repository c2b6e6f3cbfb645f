#include "reverb/power/path_interference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/rotate_back.h"
#include "reverb/fields/scattering_field.h"

namespace asdic::detail {
namespace {

/// Standard deviation of what is even over a width.
double deviation_of_even(double width) noexcept { return width / std::sqrt(12.0); }

double squared(double x) noexcept { return x * x; }

}  // namespace

PiecePhases::PiecePhases(const GroundPiece& piece, double frequency) noexcept {
  const double omega = 2.0 * pi * frequency;
  along = deviation_of_even(omega * piece.length);
  across = deviation_of_even(omega * piece.width);
  through = deviation_of_even(omega * piece.thickness);
}

double steepness(const PathPair& pair, const Vec2& towards) noexcept {
  return pair.out->horizontal_slowness * pair.leaving.dot(towards) -
         pair.back->horizontal_slowness * pair.coming.dot(towards);
}

PathInterference::PathInterference(std::span<const Vec3> phones, double frequency,
                                   const PulseCoherence& pulse, bool azimuthally_symmetric)
    : pulse_(pulse), frequency_(frequency) {
  double level = 0.0;
  for (const Vec3& x : phones) {
    level = std::max(level, frequency * x.head<2>().norm());
    reach_ = std::max(reach_, frequency * x.norm());
  }
  if (phones.empty()) return;
  if (!azimuthally_symmetric) {
    phones_.emplace(phones, frequency);
    return;
  }
  constexpr double most_apart = PhoneMean::most_apart;
  bessel_.emplace(2.0 * pi * level * most_apart + 1.0);
  // Phones whose phases are alike to 0.02 rad by any two paths are one ring at their mean place: of
  // such a mean the error is the square of that, 1e-4.
  constexpr double alike = 0.02 / (2.0 * pi * most_apart);
  std::vector<Vec2> places;  // radius and height
  for (const Vec3& x : phones)
    places.emplace_back(frequency * x.head<2>().norm(), frequency * x.z());
  std::sort(places.begin(), places.end(), [](const Vec2& a, const Vec2& b) {
    return std::pair(a.y(), a.x()) < std::pair(b.y(), b.x());
  });
  std::vector<Vec2> first;  // of each ring
  for (const Vec2& x : places) {
    const auto near = std::find_if(first.begin(), first.end(), [&](const Vec2& other) {
      return (x - other).cwiseAbs().maxCoeff() < alike;
    });
    const auto place = static_cast<std::size_t>(near - first.begin());
    if (place == first.size()) {
      first.push_back(x);
      rings_.push_back({});
    }
    Ring& ring = rings_[place];
    ring.radius += x.x();
    ring.height += x.y();
    ring.share += 1.0;
  }
  for (Ring& ring : rings_) {
    ring.radius /= ring.share;
    ring.height /= ring.share;
    ring.share /= static_cast<double>(phones.size());
  }
}

std::complex<double> PathInterference::over_phones(const Vec3& apart) const noexcept {
  constexpr double alike = 1e-3;  // [rad]
  if (2.0 * pi * apart.norm() * reach_ < alike) return 1.0;
  if (phones_) return (*phones_)(apart);
  double re = 0.0, im = 0.0;
  const auto add = [&](double amplitude, double cycles) {
    double across = 0.0;
    rotate_back(cycles, amplitude, across);
    re += amplitude;
    im += across;
  };
  // Over all bearings, ∫ e^{−iωr·cos β}dβ/2π = J₀(ωr).
  const double level = 2.0 * pi * apart.head<2>().norm();
  for (const Ring& ring : rings_)
    add(ring.share * (*bessel_)(level * ring.radius), apart.z() * ring.height);
  return {re, im};
}

/// What two sounds of one place are together, 2·Re⟨p_a p_b*⟩: a mean over the piece of ground, the
/// phones and the pulse.
class PlaceSounds::Between {
 public:
  Between(const PathInterference& interference, const GroundPiece& piece, double strongest)
      : interference_(interference),
        least_(squared(faint * strongest)),
        phases_(piece, interference.frequency()) {
    constexpr double hours = 1e4;  // [s] of a tone without end
    doppler_ = deviation_of_even(2.0 * pi * interference.frequency() *
                                 std::min(hours, interference.pulse().duration()));
  }

  [[nodiscard]] double operator()(const Sound& a, const Sound& b) const noexcept {
    if (std::norm(a.amplitude) * std::norm(b.amplitude) < least_) return 0.0;
    constexpr double nothing = 9.0;  // 1 % of their product
    const double phases = squared(phases_.along * (a.along - b.along)) +
                          squared(phases_.across * (a.across - b.across)) +
                          squared(phases_.through * (a.through - b.through)) +
                          squared(doppler_ * (a.doppler - b.doppler));
    if (!(phases < nothing)) return 0.0;
    const std::complex<double> received = interference_.over_phones(a.slowness - b.slowness) *
                                          interference_.pulse()(b.delay - a.delay);
    return 2.0 * std::exp(-0.5 * phases) * (a.amplitude * std::conj(b.amplitude) * received).real();
  }

 private:
  static constexpr double faint = 1e-3;  // product of two sounds over the strongest's power
  const PathInterference& interference_;
  double least_;
  PiecePhases phases_;
  double doppler_ = 0.0;  // the same for a Doppler factor over the pulse [rad]
};

void PlaceSounds::add(const ScatteringSheet& sheet, const PathPair& pair, const GroundPiece& piece,
                      double doppler, const Vec3& slowness, std::size_t part) {
  if (pair.of_many) return;
  if (sounds_.empty()) origin_ = pair.delay;
  const double root = std::sqrt(pair.area);
  double re = root * pair.amplitude.real(), im = root * pair.amplitude.imag();
  rotate_back(sheet.ends().frequency * (pair.delay - origin_), re, im);
  const Vec2 beside(-piece.outward.y(), piece.outward.x());
  sounds_.push_back({.amplitude = {re, im},
                     .delay = pair.delay,
                     .along = steepness(pair, piece.outward),
                     .across = steepness(pair, beside),
                     .through = pair.out_ends->down + pair.back_ends->down,
                     .doppler = doppler,
                     .slowness = slowness,
                     .part = part});
}

std::span<const double> PlaceSounds::gains(const PathInterference& interference,
                                           const GroundPiece& piece, std::size_t parts) {
  gains_.assign(parts, 1.0);
  if (sounds_.size() < 2) return gains_;
  constexpr std::size_t most = 144;
  const auto strength = [](const Sound& s) { return std::norm(s.amplitude); };
  if (sounds_.size() > most) {
    std::nth_element(sounds_.begin(), sounds_.begin() + most, sounds_.end(),
                     [&](const Sound& a, const Sound& b) { return strength(a) > strength(b); });
    sounds_.resize(most);
  }
  std::sort(sounds_.begin(), sounds_.end(),
            [](const Sound& a, const Sound& b) { return a.delay < b.delay; });
  double strongest = 0.0;
  for (const Sound& s : sounds_) strongest = std::max(strongest, strength(s));
  const double lasting = interference.pulse().duration();
  add_up({interference, piece, strongest}, interference.pulse().lasting());
  for (std::size_t begin = 0, end = 0; begin < sounds_.size(); begin = end) {
    end = begin + 1;
    while (end < sounds_.size() && sounds_[end].delay - sounds_[end - 1].delay < lasting) ++end;
    share_out(begin, end);
  }
  return gains_;
}

void PlaceSounds::add_up(const Between& between, double lasting) {
  alone_.assign(gains_.size(), 0.0);
  between_.assign(gains_.size(), 0.0);
  for (std::size_t i = 0; i < sounds_.size(); ++i) {
    Sound& a = sounds_[i];
    a.first = alone_[a.part] == 0.0;
    alone_[a.part] += std::norm(a.amplitude);
    for (std::size_t j = i + 1; j < sounds_.size(); ++j) {
      const Sound& b = sounds_[j];
      if (b.delay - a.delay >= lasting) break;
      const double both = between(a, b);
      if (a.part == b.part) {  // its two directions have this in their covariance
        alone_[a.part] += both;
        continue;
      }
      between_[a.part] += 0.5 * both;
      between_[b.part] += 0.5 * both;
    }
  }
}

/// The sum over sounds that overlap is a power, and not below 0; the share of one may be.
void PlaceSounds::share_out(std::size_t begin, std::size_t end) {
  double all = 0.0, positive = 0.0;
  const auto each = [&](auto&& of_part) {
    for (std::size_t i = begin; i < end; ++i)
      if (sounds_[i].first) of_part(sounds_[i].part);
  };
  each([&](std::size_t part) {
    const double power = alone_[part] + between_[part];
    all += power;
    positive += std::max(0.0, power);
  });
  const double share = positive > 0.0 ? std::max(0.0, all) / positive : 0.0;
  each([&](std::size_t part) {
    const double power = std::max(0.0, alone_[part] + between_[part]);
    if (alone_[part] > 0.0) gains_[part] = std::sqrt(power * share / alone_[part]);
  });
}

}  // namespace asdic::detail
