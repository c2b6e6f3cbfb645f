#include "reverb/scattering/forward_scatter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mixed_bits.h"
#include "core/random.h"
#include "reverb/scattering/motion.h"

namespace asdic::detail {
namespace {

constexpr double sea_gravity = 9.81;  // [m/s²]
constexpr double sea_beta = 0.74;     // of Pierson & Moskowitz, wind at 19.5 m
constexpr double most_waves = 200.0;  // beyond, the sum of so many stands for more, by its variance
constexpr int most_tries = 400;       // of a draw that leaves the boundary

/// Wind over a fully developed sea of a height, at 19.5 m [m/s].
double wind_of_height(double rms_height) { return std::sqrt(rms_height * sea_gravity / 0.0523); }

std::vector<RoughBounce> rough_bounces(const Environment& ocean, const Arrival& path,
                                       double frequency) {
  std::vector<RoughBounce> found;
  // Lengths of arcs are approximated in proportion to range, since rays are deflected by metres.
  // `reach` is about the range of the leg.
  double range = 0.0;
  for (const Bounce& bounce : path.bounces) range = std::max(range, bounce.range);
  const double reach = std::max(range, path.path_length * std::cos(path.launch_elevation));
  for (const Bounce& bounce : path.bounces) {
    const bool surface = bounce.boundary == BoundaryKind::surface;
    const Boundary& boundary = surface ? ocean.surface : ocean.bottom;
    if (!(boundary.roughness.rms_height > 0.0)) continue;
    const double c = sound_speed(ocean, 0.0, boundary.depth_at(0.0)).c;
    RoughBounce one;
    one.k = 2.0 * pi * frequency / c;
    one.grazing = bounce.grazing;
    one.sine = std::sin(bounce.grazing);
    one.cosine = std::cos(bounce.grazing);
    const RoughReflection left = rough_reflection(boundary.roughness, one.sine, one.k);
    one.energy = left.energy;
    one.coherent = left.coherent * left.coherent;
    const double g = 2.0 * one.k * boundary.roughness.rms_height * one.sine;
    one.mean_waves = g * g;
    const double wind = wind_of_height(boundary.roughness.rms_height);
    one.scale = std::sqrt(sea_beta) * sea_gravity / (wind * wind);
    one.moves = surface;
    one.share = reach > 0.0 ? bounce.range / reach : 0.5;
    one.along = one.share * path.path_length;
    one.range = bounce.range;
    found.push_back(one);
  }
  std::ranges::stable_sort(found, {}, &RoughBounce::along);
  double all = 1.0, mean = 1.0;
  for (auto at = found.rbegin(); at != found.rend(); ++at) {
    at->all_on = all *= at->energy;
    at->mean_on = mean *= at->coherent;
  }
  return found;
}

/// Number of waves of the sea in a kink.
struct WaveCount {
  int drawn = 1;      ///< number of waves drawn
  double root = 1.0;  ///< by which their sum is multiplied, so that it stands for more
};

/// Poisson's law, at least one wave; of large means the normal law.
class WaveCounts {
 public:
  explicit WaveCounts(double mean)
      : mean_(mean), one_(mean * std::exp(-mean)), any_(-std::expm1(-mean)) {}

  [[nodiscard]] WaveCount of(const SeaDraws::Chances& chances) const {
    if (mean_ > 100.0) {
      const double normal = std::sqrt(-2.0 * std::log(chances.normal_radius)) *
                            std::cos(2.0 * pi * chances.normal_angle);
      return standing_for(std::max(1.0, mean_ + std::sqrt(mean_) * normal));
    }
    // P(N ≥ 1) u counts down the law from 1 on
    double term = one_, left = any_ * chances.count;
    int n = 1;
    while ((left -= term) > 0.0 && n < 1000) term *= mean_ / ++n;
    return {.drawn = n};
  }

 private:
  /// Numbers a tenth apart, so that a mean that changes a little asks for the same waves.
  static WaveCount standing_for(double count) {
    double drawn = 1.0;
    while (std::floor(1.1 * drawn + 1.0) <= std::min(count, most_waves))
      drawn = std::floor(1.1 * drawn + 1.0);
    return {static_cast<int>(drawn), std::sqrt(count / drawn)};
  }

  double mean_, one_, any_;
};

/// Waves of the sea that are drawn in a try: Σ K along and across the way, Σ ±√(gK).
Kink waves(const RoughBounce& at, const WaveCount& count, const SeaDraws::Try& draw,
           SeaDraws& draws) {
  const WaveSum sum = draws.sum(draw, count.drawn);
  Kink kink;
  kink.along_way = count.root * at.scale * double(sum.along);
  kink.across = count.root * at.scale * double(sum.across);
  if (at.moves) kink.omega = count.root * std::sqrt(sea_gravity * at.scale) * double(sum.omega);
  return kink;
}

/// A place on the boundary, joined to the ends of a path by straight lines. The ends lie where
/// straight lines by the mirrored point would be as long as the path.
struct Facet {
  double way_in, way_out;    ///< distances r₁ to it and r₂ from it [m]
  double sine_in, sine_out;  ///< of the grazing angles θ₁, θ₂
  double cosine_in, cosine_out;
};

class Facets {
 public:
  Facets(const RoughBounce& at, double length)
      : at_(at), before_(at.along), after_(length - at.along), length_(length) {}

  /// Facet at which K = k(cos θ₂ − cos θ₁) for one wave of the sea with K along the path [rad/m].
  /// It lies no further behind the ends than lowest() and highest().
  [[nodiscard]] Facet by_wave(double wavenumber) const noexcept {
    const double wanted = -wavenumber / at_.k;  // cos θ₁ − cos θ₂, which grows with the place
    double low = lowest(), high = highest(), y = 0.0;
    Facet there = facet(y);
    for (int i = 0; i < 60; ++i) {
      const double over = there.cosine_in - there.cosine_out - wanted;
      (over < 0.0 ? low : high) = y;
      const double slope = there.sine_in * there.sine_in / there.way_in +
                           there.sine_out * there.sine_out / there.way_out;
      double next = y - over / slope;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      const double step = std::abs(next - y);
      y = next;
      there = facet(y);
      if (step < 1e-9 * length_) break;
    }
    return there;
  }

  /// Facet at which a slope m mirrors: θ₂ − θ₁ = 2 atan m. With y the distance beyond the mirrored
  /// path's point, tan(θ₂ − θ₁) = L sin θ y/(s(L − s) + (L − 2s) cos θ y − y²), a quadratic for y.
  [[nodiscard]] Facet by_slope(double slope) const noexcept {
    const double ways = before_ * after_,
                 b = (1.0 - slope * slope) * length_ * at_.sine -
                     2.0 * slope * (after_ - before_) * at_.cosine,
                 root = std::sqrt(b * b + 16.0 * slope * slope * ways);
    const double y = b > 0.0 ? 4.0 * slope * ways / (b + root) : (root - b) / (4.0 * slope);
    return facet(std::clamp(y, lowest(), highest()));
  }

  /// Intensity per K through a facet over that at the mirrored path, where it is largest:
  /// first-order perturbation's (sin θ₁ sin θ₂)² over both distances and over
  /// dK/dx = k(sin²θ₁/r₁ + sin²θ₂/r₂).
  [[nodiscard]] double weight_of_wave(const Facet& there) const noexcept {
    return length_ / (at_.sine * at_.sine) /
           (there.way_in / (there.sine_in * there.sine_in) +
            there.way_out / (there.sine_out * there.sine_out));
  }

  /// Intensity per slope through a facet over that at the mirrored path: Kirchhoff's
  /// (1 − cos(θ₁ + θ₂))²/(sin θ₁ + sin θ₂)³ over both distances and d slope/dx.
  [[nodiscard]] double weight_of_slope(const Facet& f) const noexcept {
    const double kink = f.cosine_in * f.cosine_out + f.sine_in * f.sine_out;  // cos(θ₂ − θ₁)
    return length_ * (f.sine_in + f.sine_out) / (1.0 + kink) /
           (f.sine_in * f.way_out + f.sine_out * f.way_in);
  }

  /// Bound of weight_of_slope(): the largest over many slopes, and 10 % more.
  [[nodiscard]] double strongest_slope() const noexcept {
    double most = 1.0;
    for (int i = -30; i <= 30; ++i) most = std::max(most, weight_of_slope(by_slope(0.05 * i)));
    return 1.1 * most;
  }

 private:
  /// \param y  distance along the boundary beyond the mirrored path's point [m]
  [[nodiscard]] Facet facet(double y) const noexcept {
    const double x1 = before_ * at_.cosine + y, x2 = after_ * at_.cosine - y,
                 d1 = before_ * at_.sine, d2 = after_ * at_.sine;
    const double r1 = std::sqrt(x1 * x1 + d1 * d1), r2 = std::sqrt(x2 * x2 + d2 * d2);
    return {.way_in = r1,
            .way_out = r2,
            .sine_in = d1 / r1,
            .sine_out = d2 / r2,
            .cosine_in = x1 / r1,
            .cosine_out = x2 / r2};
  }
  // Limits of y, some depths of the ends behind them: what comes from beyond is negligible.
  [[nodiscard]] double lowest() const noexcept { return -before_ * (at_.cosine + 3.0 * at_.sine); }
  [[nodiscard]] double highest() const noexcept { return after_ * (at_.cosine + 3.0 * at_.sine); }

  const RoughBounce& at_;
  double before_, after_, length_;
};

/// Kinks of the parts at one bounce. Each joins the ends of the path: by one wave of the sea, or by
/// the slope of many.
class KinksOfBounce {
 public:
  KinksOfBounce(const RoughBounce& at, double length, SeaDraws& draws)
      : at_(at), length_(length), facets_(at, length), counts_(at.mean_waves), draws_(draws) {}

  /// \param first  the first try of the part at this bounce
  Kink draw(const SeaDraws::Try& first) {
    const double slopes = -2.0 * at_.k * at_.sine;  // K over slope
    for (SeaDraws::Try one = first; one.number < most_tries; ++one.number) {
      const SeaDraws::Chances chances = draws_.chances(one);
      const WaveCount count = counts_.of(chances);
      Kink kink = waves(at_, count, one, draws_);
      kink.aside = kink.across / at_.k;
      if (!(std::abs(kink.aside) < 1.0)) continue;
      const bool single = count.drawn == 1;
      if (single && !(std::abs(kink.along_way) < 2.0 * at_.k)) continue;
      if (strongest_ == 0.0) strongest_ = facets_.strongest_slope();
      const Facet there =
          single ? facets_.by_wave(kink.along_way) : facets_.by_slope(kink.along_way / slopes);
      const double weight = single ? facets_.weight_of_wave(there) : facets_.weight_of_slope(there);
      if (!(chances.acceptance * strongest_ < weight)) continue;
      const double in = std::atan2(there.sine_in, there.cosine_in),
                   out = std::atan2(there.sine_out, there.cosine_out);
      kink.down = out - in;
      kink.out = out - at_.grazing;
      kink.excess = there.way_in + there.way_out - length_ +
                    0.5 * kink.aside * kink.aside * at_.along * (length_ - at_.along) / length_;
      return kink;
    }
    return {};
  }

 private:
  const RoughBounce& at_;
  double length_;
  Facets facets_;
  WaveCounts counts_;
  SeaDraws& draws_;
  double strongest_ = 0.0;  // Facets::strongest_slope(), once it is asked for
};

/// Length that the kinks of one leg add to it [m]: the sum of their own, and δ_i δ_j s_<(L − s_>)/L
/// for every two of them, for turns down and for turns aside.
class Excess {
 public:
  explicit Excess(double length) : length_(length) {}
  /// \param along  place of the kink, not before that of the last one added [m]
  void add(const Kink& kink, double along) noexcept {
    sum_ += kink.excess + (kink.down * down_ + kink.aside * aside_) * (length_ - along) / length_;
    down_ += kink.down * along;
    aside_ += kink.aside * along;
  }
  [[nodiscard]] double sum() const noexcept { return sum_; }

 private:
  double length_, sum_ = 0.0, down_ = 0.0, aside_ = 0.0;
};

}  // namespace

double scatter_doppler(const Environment& ocean, double frequency) {
  const Roughness& rough = ocean.surface.roughness;
  if (!(rough.rms_height > 0.0)) return 0.0;
  // ∫S(K) gK dK = α√π U²/(4√β)
  const double velocity = 0.0646 * wind_of_height(rough.rms_height);
  constexpr double slowest_sea = 1300.0;
  return 2.2 * 4.0 * velocity / slowest_sea +
         1.1 * bragg_shift(4.0 * pi * frequency / slowest_sea) / frequency;
}

std::uint64_t scatter_history(const Arrival& path) noexcept {
  // There is one direct path, whether it goes up or down.
  const bool direct =
      path.surface_bounces + path.bottom_bounces + path.upper_turns + path.lower_turns == 0;
  std::uint64_t name = !direct && path.launch_elevation > 0.0 ? 1 : 0;
  for (const int count :
       {path.surface_bounces, path.bottom_bounces, path.upper_turns, path.lower_turns})
    name = mixed(name, static_cast<std::uint64_t>(count));
  return name;
}

RoughPath rough_path(const Environment& ocean, const Arrival& path, double frequency, int parts,
                     SeaDraws& draws, std::uint64_t entity) {
  RoughPath rough{.length = path.path_length,
                  .delay = path.delay,
                  .bounces = rough_bounces(ocean, path, frequency),
                  .kinks = {}};
  const std::size_t bounces = rough.bounces.size();
  rough.kinks.resize(static_cast<std::size_t>(parts) * bounces);
  for (std::size_t i = 0; i < bounces; ++i) {
    KinksOfBounce kinks(rough.bounces[i], rough.length, draws);
    for (int part = 0; part < parts; ++part)
      rough.kinks[static_cast<std::size_t>(part) * bounces + i] =
          kinks.draw({.path = entity, .part = part, .bounce = i});
  }
  return rough;
}

std::vector<ScatteredPart> forward_scatter(const Environment& ocean,
                                           std::span<const ScatteredLeg> legs, double frequency,
                                           int parts, std::uint64_t seed, std::uint64_t entity) {
  // Share of the energy, in all or of the mean field, that is left after some legs.
  const auto left = [](std::span<const ScatteredLeg> some, double RoughBounce::*of) {
    double product = 1.0;
    for (const ScatteredLeg& leg : some)
      if (!leg.path->bounces.empty()) product *= leg.path->bounces.front().*of;
    return product;
  };
  std::vector<ScatteredPart> found;
  if (!(left(legs, &RoughBounce::all_on) > left(legs, &RoughBounce::mean_on))) return found;
  const double c = sound_speed(ocean, 0.0, ocean.surface.depth_at(0.0)).c;
  const double largest_shift = frequency * scatter_doppler(ocean, frequency);
  found.reserve(static_cast<std::size_t>(parts));
  for (int part = 0; part < parts; ++part) {
    RandomStream draws(seed, Draw::forward_scatter, static_cast<std::uint32_t>(part), entity);
    const std::complex<double> weight = draws.complex_normal() / std::sqrt(double(parts));
    bool scattered = false;  // by a bounce before
    double phase = 0.0, longer = 0.0;
    ScatteredPart one;
    for (std::size_t l = 0; l < legs.size(); ++l) {
      const ScatteredLeg& leg = legs[l];
      const bool last = l + 1 == legs.size();
      const double all = left(legs.subspan(l + 1), &RoughBounce::all_on),
                   mean = left(legs.subspan(l + 1), &RoughBounce::mean_on);
      const Vec2 ahead(std::sin(leg.bearing), std::cos(leg.bearing)), right(ahead.y(), -ahead.x());
      const auto& bounces = leg.path->bounces;
      Excess excess(leg.path->length);
      for (std::size_t i = 0; i < bounces.size(); ++i) {
        const RoughBounce& at = bounces[i];
        const double here = at.energy - at.coherent,
                     after = all * (i + 1 < bounces.size() ? bounces[i + 1].all_on : 1.0);
        const double chance =
            scattered ? here / at.energy
                      : here * after / std::max(all * at.all_on - mean * at.mean_on, 1e-300);
        if (!(draws.uniform() < chance)) continue;
        scattered = true;
        const Kink& kink = leg.path->kinks[static_cast<std::size_t>(part) * bounces.size() + i];
        excess.add(kink, at.along);
        phase += kink.omega * (leg.start + at.share * leg.path->delay) -
                 (kink.along_way * ahead + kink.across * right).dot(leg.from + at.range * ahead);
        one.shift += kink.omega / (2.0 * pi);
        if (!last) continue;
        // Change of direction at the end of the last leg. A ray that leaves the surface more
        // steeply also arrives more steeply.
        one.elevation -= kink.out * (at.moves ? 1.0 : -1.0);
        one.bearing += kink.aside * at.share / std::max(at.cosine, 0.1);
      }
      longer += excess.sum();
    }
    one.delay = std::max(longer, 0.0) / c;
    one.shift = std::clamp(one.shift, -largest_shift, largest_shift);
    one.amplitude = std::polar(1.0, phase) * weight;
    found.push_back(one);
  }
  return found;
}

}  // namespace asdic::detail
