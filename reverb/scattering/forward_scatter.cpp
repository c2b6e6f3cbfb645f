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
constexpr int most_waves = 200;       // beyond, the sum of so many stands for more, by its variance
constexpr int most_tries = 400;       // of a draw that leaves the boundary

/// One bounce off a rough boundary.
struct RoughBounce {
  RoughReflection left;
  double mean_waves = 0.0;  ///< G²
  double scale = 0.0;       ///< K of the spectrum: K² = scale²/(−ln u) [rad/m]
  double strongest = 1.0;   ///< the most that by_slope() weighs
  bool moves = false;
  double k = 0.0, grazing = 0.0;
  double along = 0.0;   ///< s, of its leg [m]
  double length = 0.0;  ///< L of its leg [m]
  std::size_t leg = 0;
  Vec2 place = Vec2::Zero(), ahead = Vec2::Zero();  ///< on the map; unit vector of travel
  double time = 0.0;                                ///< since the start of the scenario [s]
};

/// Wind over a fully developed sea of a height, at 19.5 m [m/s].
double wind_of_height(double rms_height) { return std::sqrt(rms_height * sea_gravity / 0.0523); }

std::vector<RoughBounce> rough_bounces(const Environment& ocean, std::span<const ScatteredLeg> legs,
                                       double frequency) {
  std::vector<RoughBounce> found;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Arrival& path = *legs[i].path;
    // Arcs are long in proportion to range: what deflects a ray by metres asks for no more.
    double range = 0.0;
    for (const Bounce& bounce : path.bounces) range = std::max(range, bounce.range);
    const double reach =
        std::max(range, path.path_length * std::cos(path.launch_elevation));  // of the leg, about
    const Vec2 ahead(std::sin(legs[i].bearing), std::cos(legs[i].bearing));
    for (const Bounce& bounce : path.bounces) {
      const bool surface = bounce.boundary == BoundaryKind::surface;
      const Boundary& boundary = surface ? ocean.surface : ocean.bottom;
      if (!(boundary.roughness.rms_height > 0.0)) continue;
      const double c = sound_speed(ocean, 0.0, boundary.depth_at(0.0)).c;
      RoughBounce one;
      one.k = 2.0 * pi * frequency / c;
      one.grazing = bounce.grazing;
      one.left = rough_reflection(boundary.roughness, std::sin(bounce.grazing), one.k);
      const double g = 2.0 * one.k * boundary.roughness.rms_height * std::sin(bounce.grazing);
      one.mean_waves = g * g;
      const double wind = wind_of_height(boundary.roughness.rms_height);
      one.scale = std::sqrt(sea_beta) * sea_gravity / (wind * wind);
      one.moves = surface;
      const double share = reach > 0.0 ? bounce.range / reach : 0.5;
      one.length = path.path_length;
      one.along = share * path.path_length;
      one.leg = i;
      one.ahead = ahead;
      one.place = legs[i].from + bounce.range * ahead;
      one.time = legs[i].start + share * path.delay;
      found.push_back(one);
    }
  }
  return found;
}

/// Poisson's law, at least one; of large means by the normal law.
int at_least_one(double mean, RandomStream& draws) {
  if (mean > 100.0)
    return std::max(1, static_cast<int>(std::lround(mean + std::sqrt(mean) * draws.normal())));
  // P(N ≥ 1) u counts down the law from 1 on
  double term = mean * std::exp(-mean), left = -std::expm1(-mean) * draws.uniform();
  int n = 1;
  while ((left -= term) > 0.0 && n < 1000) term *= mean / ++n;
  return n;
}

/// A ray's change of direction, and what the sea's waves that made it do to its phase.
struct Kink {
  double down = 0.0, aside = 0.0;  ///< [rad]
  double out = 0.0;                ///< θ₂ less the mirrored path's grazing angle [rad]
  double excess = 0.0;             ///< of the way's length [m]
  Vec2 wavenumber = Vec2::Zero();  ///< on the map [rad/m]
  double omega = 0.0;              ///< [rad/s]
};

/// `count` waves of the sea: Σ K along and across the way, Σ ±√(gK).
Kink waves(const RoughBounce& at, int count, Sea sea, RandomStream& draws) {
  const int drawn = std::min(count, most_waves);
  double along = 0.0, across = 0.0, omega = 0.0;
  for (int i = 0; i < drawn; ++i) {
    const double wave = at.scale / std::sqrt(-std::log(draws.uniform()));
    const double u = draws.uniform();
    const double towards = sea == Sea::isotropic ? 2.0 * pi * u : u < 0.5 ? 0.0 : pi;
    const double way = draws.uniform() < 0.5 ? -1.0 : 1.0;
    along += wave * std::cos(towards);
    across += wave * std::sin(towards);
    if (at.moves) omega += way * std::sqrt(sea_gravity * wave);
  }
  const double grown = std::sqrt(double(count) / drawn);
  Kink kink;
  kink.wavenumber = grown * Vec2(along, across);
  kink.omega = grown * omega;
  return kink;
}

/// A place on the boundary that joins the two ends of the path, by straight ways.
struct Facet {
  double grazing_in, grazing_out;  ///< θ₁, θ₂ [rad]
  double way_in, way_out;          ///< r₁ to it, r₂ from it [m]
};

/// The place x where `rises`, a function of the facet that grows with x, is `wanted`. The ends lie
/// as far from the boundary and apart as straight ways by the mirror ask for.
template <class Rises>
Facet facet(const RoughBounce& at, double wanted, const Rises& rises) {
  const double sine = std::sin(at.grazing), apart = at.length * std::cos(at.grazing);
  const double d1 = at.along * sine, d2 = (at.length - at.along) * sine;
  const auto make = [&](double x) {
    return Facet{.grazing_in = std::atan2(d1, x),
                 .grazing_out = std::atan2(d2, apart - x),
                 .way_in = std::hypot(x, d1),
                 .way_out = std::hypot(apart - x, d2)};
  };
  double low = -3.0 * d1, high = apart + 3.0 * d2;  // behind the ends, as far as it is worth
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (rises(make(middle)) < wanted ? low : high) = middle;
  }
  return make(0.5 * (low + high));
}

/// Where one wave's K along the way is k(cos θ₂ − cos θ₁), and the intensity per K that comes by
/// way of it over that at the mirrored path: first-order perturbation's (sin θ₁ sin θ₂)² over both
/// ways and over dK/dx = k(sin²θ₁/r₁ + sin²θ₂/r₂). It is most at the mirrored path, 1.
std::pair<Facet, double> by_wave(const RoughBounce& at, double wavenumber) {
  const Facet there = facet(at, -wavenumber / at.k, [](const Facet& f) {
    return std::cos(f.grazing_in) - std::cos(f.grazing_out);
  });
  const double sine = std::sin(at.grazing), in = std::sin(there.grazing_in),
               out = std::sin(there.grazing_out);
  return {there,
          at.length / (sine * sine) / (there.way_in / (in * in) + there.way_out / (out * out))};
}

/// Where a slope mirrors, θ₂ − θ₁ = 2 atan(slope), and the intensity per slope over that at the
/// mirrored path: Kirchhoff's (1 − cos(θ₁ + θ₂))²/(sin θ₁ + sin θ₂)³ over both ways and over
/// d slope/dx.
std::pair<Facet, double> by_slope(const RoughBounce& at, double slope) {
  const Facet there = facet(at, 2.0 * std::atan(slope),
                            [](const Facet& f) { return f.grazing_out - f.grazing_in; });
  const double middle = 0.5 * (there.grazing_in + there.grazing_out),
               half_kink = 0.5 * (there.grazing_out - there.grazing_in);
  return {there, at.length * std::sin(middle) / std::cos(half_kink) /
                     (std::sin(there.grazing_in) * there.way_out +
                      std::sin(there.grazing_out) * there.way_in)};
}

/// The most that by_slope() weighs, anywhere.
double strongest_slope(const RoughBounce& at) {
  double most = 1.0;
  for (int i = -30; i <= 30; ++i) most = std::max(most, by_slope(at, 0.05 * i).second);
  return 1.1 * most;
}

/// A kink that joins the ends of the path: by one wave of the sea, or by the slope of many.
Kink kink_at(const RoughBounce& at, Sea sea, RandomStream& draws) {
  const double sine = std::sin(at.grazing), slopes = -2.0 * at.k * sine;  // K over slope
  for (int i = 0; i < most_tries; ++i) {
    const int count = at_least_one(at.mean_waves, draws);
    Kink kink = waves(at, count, sea, draws);
    const double chance = draws.uniform(), aside = kink.wavenumber.y() / at.k;
    const double along = kink.wavenumber.x();
    if (!(std::abs(aside) < 1.0)) continue;
    if (count == 1 && !(std::abs(along) < 2.0 * at.k)) continue;
    const auto [there, weight] = count == 1 ? by_wave(at, along) : by_slope(at, along / slopes);
    if (!(chance * at.strongest < weight)) continue;
    kink.down = there.grazing_out - there.grazing_in;
    kink.out = there.grazing_out - at.grazing;
    kink.aside = aside;
    kink.excess = there.way_in + there.way_out - at.length +
                  0.5 * aside * aside * at.along * (at.length - at.along) / at.length;
    const Vec2 right(at.ahead.y(), -at.ahead.x());
    kink.wavenumber = along * at.ahead + kink.wavenumber.y() * right;
    return kink;
  }
  return {};
}

/// What the kinks of each leg add to its length: each for itself, and every two of one leg
/// δ_i δ_j s_<(L − s_>)/L, both ways of turning [m].
double excess(std::span<const RoughBounce> bounces, std::span<const Kink> kinks) {
  double sum = 0.0;
  for (std::size_t i = 0; i < bounces.size(); ++i) {
    sum += kinks[i].excess;
    for (std::size_t j = 0; j < i; ++j) {
      if (bounces[i].leg != bounces[j].leg) continue;
      const double near = std::min(bounces[i].along, bounces[j].along),
                   far = std::max(bounces[i].along, bounces[j].along);
      sum += (kinks[i].down * kinks[j].down + kinks[i].aside * kinks[j].aside) * near *
             (bounces[i].length - far) / bounces[i].length;
    }
  }
  return std::max(sum, 0.0);
}

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
  std::uint64_t name = path.launch_elevation > 0.0 ? 1 : 0;
  for (const int count :
       {path.surface_bounces, path.bottom_bounces, path.upper_turns, path.lower_turns})
    name = mixed(name, static_cast<std::uint64_t>(count));
  return name;
}

std::vector<ScatteredPart> forward_scatter(const Environment& ocean,
                                           std::span<const ScatteredLeg> legs, double frequency,
                                           int parts, std::uint64_t seed, std::uint64_t entity,
                                           Sea sea) {
  std::vector<RoughBounce> bounces = rough_bounces(ocean, legs, frequency);
  // Of the bounces from each on: energy in all, and energy of the mean field
  std::vector<double> all(bounces.size() + 1, 1.0), mean(bounces.size() + 1, 1.0);
  for (std::size_t i = bounces.size(); i-- > 0;) {
    all[i] = all[i + 1] * bounces[i].left.energy;
    mean[i] = mean[i + 1] * bounces[i].left.coherent * bounces[i].left.coherent;
  }
  for (RoughBounce& at : bounces) at.strongest = strongest_slope(at);
  std::vector<ScatteredPart> found;
  if (bounces.empty() || !(all[0] > mean[0])) return found;
  const double c = sound_speed(ocean, 0.0, ocean.surface.depth_at(0.0)).c;
  const double largest_shift = frequency * scatter_doppler(ocean, frequency);
  std::vector<Kink> kinks(bounces.size());
  for (int part = 0; part < parts; ++part) {
    RandomStream draws(seed, Draw::forward_scatter, static_cast<std::uint32_t>(part), entity);
    const std::complex<double> weight = draws.complex_normal() / std::sqrt(double(parts));
    bool scattered = false;  // by a bounce before
    double phase = 0.0;
    ScatteredPart one;
    for (std::size_t i = 0; i < bounces.size(); ++i) {
      const RoughBounce& at = bounces[i];
      const double here = at.left.energy - at.left.coherent * at.left.coherent;
      const double chance = scattered ? here / at.left.energy
                                      : here * all[i + 1] / std::max(all[i] - mean[i], 1e-300);
      kinks[i] = {};
      if (!(draws.uniform() < chance)) continue;
      scattered = true;
      const Kink& kink = kinks[i] = kink_at(at, sea, draws);
      phase += kink.omega * at.time - kink.wavenumber.dot(at.place);
      one.shift += kink.omega / (2.0 * pi);
      if (at.leg + 1 < legs.size()) continue;
      // Towards the end of the last leg: a ray that leaves the surface more steeply goes down more.
      const double lever = at.along / at.length;
      one.elevation -= kink.out * (at.moves ? 1.0 : -1.0);
      one.bearing += kink.aside * lever / std::max(std::cos(at.grazing), 0.1);
    }
    one.delay = excess(bounces, kinks) / c;
    one.shift = std::clamp(one.shift, -largest_shift, largest_shift);
    one.amplitude = std::polar(1.0, phase) * weight;
    found.push_back(one);
  }
  return found;
}

}  // namespace asdic::detail
