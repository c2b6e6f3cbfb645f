// What a rough sea scatters about the mirrored path: energy, delay, Doppler, fluctuation.
#include "reverb/scattering/forward_scatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <vector>

#include "core/random.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {
namespace {

/// Deep water of one speed under the sea of a wind.
Environment under(double wind) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.surface.roughness = {
      .rms_height = pierson_moskowitz_height(wind), .sea_wind = wind, .floor_db = -300.0};
  ocean.bottom = {.depth = 4000.0, .material = Rigid{}};
  return ocean;
}

/// The path by the surface alone, its ends `slant` before and behind the bounce.
Arrival bounced(const Environment& ocean, double grazing, double slant, double frequency) {
  const double depth = slant * std::sin(grazing), range = 2.0 * slant * std::cos(grazing);
  const Arrivals all = EigenraySolver(ocean).find(
      depth, depth, range, frequency, {.max_surface_bounces = 1, .max_bottom_bounces = 0});
  for (const Arrival& path : all)
    if (path.surface_bounces == 1) return path;
  throw std::runtime_error("no such path");
}

std::vector<ScatteredPart> parts_of(const Environment& ocean, const Arrival& path, double frequency,
                                    int parts, std::uint64_t entity, double time = 0.0,
                                    Sea sea = Sea::isotropic, Vec2 from = Vec2::Zero()) {
  SeaDraws draws(1, sea);
  const RoughPath rough = rough_path(ocean, path, frequency, parts, draws, entity);
  const ScatteredLeg leg{&rough, from, 0.5 * pi, time};
  return forward_scatter(ocean, std::span(&leg, 1), frequency, parts, 1, entity);
}

// E Σ|a|² = 1: 400 sums of 16 exponentials, 4.9 σ = 4.9/√6400.
TEST(ForwardScatter, KeepsTheEnergy) {
  const Environment ocean = under(10.0);
  const Arrival path = bounced(ocean, radians(10.0), 1000.0, 3500.0);
  EXPECT_GT(path.scattered, 100.0 * std::norm(path.amplitude));
  double energy = 0.0;
  for (std::uint64_t entity = 0; entity < 400; ++entity)
    for (const ScatteredPart& part : parts_of(ocean, path, 3500.0, 16, entity))
      energy += std::norm(part.amplitude) / 400.0;
  EXPECT_NEAR(energy, 1.0, 4.9 / 80.0);
}

/// Delays of what long-crested Pierson–Moskowitz seas scatter, by brute force: Kirchhoff's integral
/// over the points of drawn surfaces from a point source to a point receiver at many frequencies,
/// and the mean |p − ⟨p⟩|² over delay. A plain program beside the code under test: straight
/// distances, no spectra of directions, no saddle points.
struct SpreadOfDelay {
  double mean = 0.0;      ///< after the mirrored path [s]
  double coherent = 0.0;  ///< |⟨p⟩|²/⟨|p|²⟩
};

SpreadOfDelay brute_force(double frequency, double wind, double grazing, double slant, double band,
                          std::size_t surfaces) {
  using Complex = std::complex<double>;
  constexpr double c = 1500.0;
  constexpr std::size_t frequencies = 96, waves = 200;
  const double depth = slant * std::sin(grazing), half = slant * std::cos(grazing);
  const double reach = 1.5 * half, dx = c / frequency / 6.0;
  const auto n = static_cast<std::size_t>(2.0 * reach / dx);
  const double u2 = std::pow(1.026 * wind, 2), longest = 0.25 * 9.81 / u2,
               shortest = 2.0 * pi * frequency / c;
  std::vector<std::vector<Complex>> p(surfaces, std::vector<Complex>(frequencies));
  for (std::size_t s = 0; s < surfaces; ++s) {
    RandomStream draws(1, Draw::study_input, static_cast<std::uint32_t>(s), 9);
    std::vector<double> z(n, 0.0), slope(n, 0.0);
    const double step = std::log(shortest / longest) / waves;
    for (std::size_t i = 0; i < waves; ++i) {
      const double wave = longest * std::exp((double(i) + draws.uniform()) * step);
      const double density =
          0.0081 / 2.0 * std::pow(wave, -3) * std::exp(-0.74 * std::pow(9.81 / (wave * u2), 2));
      Complex now = draws.complex_normal() * std::sqrt(2.0 * density * wave * step);
      const Complex turn = std::polar(1.0, wave * dx);
      for (std::size_t j = 0; j < n; ++j, now *= turn) {
        z[j] += now.real();
        slope[j] -= wave * now.imag();
      }
    }
    for (std::size_t j = 0; j < n; ++j) {
      const double x = (double(j) - 0.5 * double(n)) * dx;
      const double edge = std::clamp((std::abs(x) / reach - 0.8) / 0.2, 0.0, 1.0);
      const double r1 = std::hypot(x + half, z[j] + depth), r2 = std::hypot(x - half, z[j] + depth);
      const double facing = (z[j] + depth - slope[j] * (x + half)) / r1;  // grad of the incident
      if (facing <= 0.0 || edge >= 1.0) continue;
      const double weight = facing / std::sqrt(r1 * r2) * std::pow(std::cos(0.5 * pi * edge), 2);
      const double way = (r1 + r2 - 2.0 * slant) / c;
      const double first = frequency - 0.5 * band;
      Complex now = std::polar(weight, -2.0 * pi * first * way);
      const Complex turn = std::polar(1.0, -2.0 * pi * band / double(frequencies) * way);
      for (Complex& value : p[s]) {
        value += now;
        now *= turn;
      }
    }
  }
  std::vector<Complex> mean(frequencies, 0.0);
  double power = 0.0, coherent = 0.0;
  for (const auto& one : p)
    for (std::size_t k = 0; k < frequencies; ++k) {
      mean[k] += one[k] / double(surfaces);
      power += std::norm(one[k]) / double(surfaces);
    }
  for (const Complex& m : mean) coherent += std::norm(m);
  // intensity over delay by a plain transform with a Hann window; late delays are those before
  double total = 0.0, moment = 0.0;
  for (std::size_t t = 0; t < frequencies; ++t) {
    const double late = double(t) < 0.85 * frequencies ? double(t) : double(t) - frequencies;
    for (const auto& one : p) {
      Complex sum = 0.0;
      for (std::size_t k = 0; k < frequencies; ++k)
        sum += (one[k] - mean[k]) * (1.0 - std::cos(2.0 * pi * double(k) / frequencies)) *
               std::polar(1.0, 2.0 * pi * double(k * t) / frequencies);
      total += std::norm(sum);
      moment += std::norm(sum) * late;
    }
  }
  return {moment / total / band, coherent / power};
}

// The mean delay of what is scattered within 1 dB of Kirchhoff integrals over drawn surfaces (96 of
// them have one standard error of 0.4 dB, 480 of 0.2 dB). Where waves come one by one (G = 0.8),
// where slopes do (2.9 to 5.6), and where two or three waves make a slope (1.6).
TEST(ForwardScatter, DelaysOfBruteForceSurfaces) {
  struct Case {
    double frequency, wind, grazing_deg, slant, band;
    std::size_t surfaces = 96;
  };
  for (const Case& at : {Case{1000.0, 10.0, 10.0, 800.0, 300.0},
                         {2000.0, 10.0, 10.0, 600.0, 600.0, 480},
                         {3500.0, 10.0, 20.0, 250.0, 1600.0},
                         {3500.0, 10.0, 10.0, 500.0, 1000.0},
                         {2000.0, 15.0, 15.0, 300.0, 800.0}}) {
    const Environment ocean = under(at.wind);
    const double grazing = radians(at.grazing_deg);
    const Arrival path = bounced(ocean, grazing, at.slant, at.frequency);
    const SpreadOfDelay truth =
        brute_force(at.frequency, at.wind, grazing, at.slant, at.band, at.surfaces);
    constexpr int draws = 20000;
    double mean = 0.0;
    for (const ScatteredPart& part :
         parts_of(ocean, path, at.frequency, draws, 7, 0.0, Sea::long_crested))
      mean += part.delay / draws;
    EXPECT_NEAR(db_from_power(mean / truth.mean), 0.0, 1.0) << at.frequency << ": " << mean;
    const double coherent =
        std::norm(path.amplitude) / (std::norm(path.amplitude) + path.scattered);
    EXPECT_NEAR(coherent, truth.coherent, 0.03) << at.frequency;  // 1/96, and the law's 2 %
  }
}

// Of a sea that is hardly rough the sound is shifted by one wave's frequency: lines about
// ±√(gQ)/2π. Their mean square by a sum over places x of the boundary and waves across: first-order
// perturbation's (sin θ₁ sin θ₂)²/(r₁r₂) times the spectrum at the K that joins the ends there.
// 4.9 σ of the draws; two waves are drawn in G²/2 = 0.4 % of all.
TEST(ForwardScatter, LinesOfTheWavesOfTheSea) {
  const double f = 1000.0, wind = 4.0, grazing = radians(8.0), k = 2.0 * pi * f / 1500.0;
  const double slant = 1000.0, depth = slant * std::sin(grazing), half = slant * std::cos(grazing);
  const Environment ocean = under(wind);
  const Arrival path = bounced(ocean, grazing, slant, f);
  double expected = 0.0, total = 0.0;
  const double u2 = std::pow(1.026 * wind, 2);
  for (double x = -half - 3.0 * depth; x < half + 3.0 * depth; x += 0.5)
    for (double across = -k; across < k; across += 0.002 * k) {
      const double r1 = std::hypot(half + x, depth), r2 = std::hypot(half - x, depth);
      const double along = k * ((half - x) / r2 - (half + x) / r1);
      const double wave = std::hypot(along, across + 0.001 * k);
      const double weight = std::pow(depth * depth / (r1 * r2), 2) / (r1 * r2) *
                            std::pow(wave, -4) * std::exp(-0.74 * std::pow(9.81 / (wave * u2), 2));
      total += weight;
      expected += weight * 9.81 * wave / std::pow(2.0 * pi, 2);
    }
  expected /= total;
  constexpr int draws = 20000;
  double mean = 0.0, square = 0.0, signs = 0.0;
  for (const ScatteredPart& part : parts_of(ocean, path, f, draws, 3)) {
    const double s2 = part.shift * part.shift;
    mean += s2 / draws;
    square += s2 * s2 / draws;
    signs += std::copysign(1.0, part.shift) / draws;
  }
  const double error = 4.9 * std::sqrt((square - mean * mean) / draws);
  EXPECT_NEAR(mean, expected, error + 0.02 * expected);
  EXPECT_NEAR(signs, 0.0, 4.9 / std::sqrt(double(draws)));
}

/// ⟨I²⟩/⟨I⟩² − 1 of the sum of the mean field and the parts, over times far apart.
double scintillation(const Environment& ocean, const Arrival& path, double frequency) {
  double first = 0.0, second = 0.0;
  constexpr int times = 4000;
  for (int i = 0; i < times; ++i) {
    std::complex<double> sum = path.amplitude;
    for (const ScatteredPart& part :
         parts_of(ocean, path, frequency, 16, std::uint64_t(i / 10), 777.0 * i))
      sum += std::sqrt(path.scattered) * part.amplitude *
             std::polar(1.0, -2.0 * pi * frequency * part.delay);
    first += std::norm(sum) / times;
    second += std::norm(sum) * std::norm(sum) / times;
  }
  return second / (first * first) - 1.0;
}

// Rice: with the share s of the intensity scattered the index is 1 − (1 − s)². Draws of one sea are
// not independent: 400 seas of ten times, 4.9 σ of 400 of the larger.
TEST(ForwardScatter, ScintillatesAsRiceDoes) {
  for (const double frequency : {400.0, 1500.0, 10000.0}) {
    const Environment ocean = under(frequency > 5000.0 ? 15.0 : 8.0);
    const Arrival path = bounced(ocean, radians(10.0), 1000.0, frequency);
    const double share = path.scattered / (path.scattered + std::norm(path.amplitude));
    EXPECT_NEAR(scintillation(ocean, path, frequency), 1.0 - (1.0 - share) * (1.0 - share), 0.3)
        << frequency << ": " << share;
  }
}

// A kink joins the path's ends by straight lines over a place of the boundary. The ends are as far
// apart and as deep as those of the mirrored path, the lines are longer than it by `excess`, and
// for one wave of the sea K is k(cos θ₂ − cos θ₁). The two triangles are solved here by their
// angles. The tolerance is rounding, which tangents of angles of 10⁻³ amplify by 10⁶.
TEST(ForwardScatter, KinksJoinTheEnds) {
  for (const auto& [wind, frequency] : {std::pair(4.0, 500.0), {15.0, 3500.0}}) {
    const Environment ocean = under(wind);
    const double k = 2.0 * pi * frequency / 1500.0;
    const Arrival path = bounced(ocean, radians(6.0), 700.0, frequency);
    const double length = path.path_length, grazing = path.bounces[0].grazing;
    SeaDraws draws(1);
    const RoughPath rough = rough_path(ocean, path, frequency, 500, draws, 5);
    ASSERT_EQ(rough.bounces.size(), 1U);
    ASSERT_EQ(rough.kinks.size(), 500U);
    const double before = rough.bounces[0].along, after = length - before;
    EXPECT_NEAR(before, after, 0.01);
    const double d1 = before * std::sin(grazing), d2 = after * std::sin(grazing);
    int one_by_one = 0, turned = 0;
    for (const Kink& kink : rough.kinks) {
      const double out = grazing + kink.out, in = out - kink.down;
      ASSERT_GT(in, 0.0);
      ASSERT_GT(out, 0.0);
      turned += std::abs(kink.down) > 0.01 ? 1 : 0;
      const double bowed = 0.5 * kink.aside * kink.aside * before * after / length;  // sideways
      EXPECT_NEAR(kink.excess - bowed, d1 / std::sin(in) + d2 / std::sin(out) - length,
                  1e-9 * length);
      EXPECT_NEAR(d1 / std::tan(in) + d2 / std::tan(out), length * std::cos(grazing),
                  1e-9 * length);
      // Both laws agree on small slopes.
      if (std::abs(kink.down) > 1e-3 &&
          std::abs(kink.along_way - k * (std::cos(out) - std::cos(in))) < 1e-9 * k)
        ++one_by_one;
    }
    EXPECT_GT(turned, 250);
    if (wind < 5.0)  // G² = 0.01: fewer than 20 of 500 kinks have two waves
      EXPECT_GT(one_by_one, 480);
    else  // G² = 13
      EXPECT_LT(one_by_one, 5);
  }
}

// From ping to ping, and from place to place, by the motion of the waves: the same at once, new a
// minute later or a kilometre away.
TEST(ForwardScatter, ChangesWithTimeAndPlace) {
  const double f = 10000.0;
  const Environment ocean = under(15.0);
  const Arrival path = bounced(ocean, radians(10.0), 1000.0, f);
  const auto coherence = [&](double later, Vec2 aside) {
    std::complex<double> product = 0.0;
    double power = 0.0;
    for (std::uint64_t entity = 0; entity < 500; ++entity) {
      const auto a = parts_of(ocean, path, f, 16, entity, 0.0);
      const auto b = parts_of(ocean, path, f, 16, entity, later, Sea::isotropic, aside);
      std::complex<double> sum_a = 0.0, sum_b = 0.0;
      for (std::size_t i = 0; i < a.size(); ++i) sum_a += a[i].amplitude, sum_b += b[i].amplitude;
      product += sum_a * std::conj(sum_b);
      power += 0.5 * (std::norm(sum_a) + std::norm(sum_b));
    }
    return std::abs(product) / power;
  };
  EXPECT_GT(coherence(0.0, Vec2::Zero()), 0.999999);
  EXPECT_LT(coherence(60.0, Vec2::Zero()), 4.9 / std::sqrt(500.0));
  EXPECT_LT(coherence(0.0, Vec2(1000.0, 0.0)), 4.9 / std::sqrt(500.0));
  EXPECT_GT(coherence(1e-4, Vec2::Zero()), 0.99);  // k·sin θ·2·(vertical speed)·10⁻⁴ s ≪ 1
}

}  // namespace
}  // namespace asdic::detail
