#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <random>
#include <vector>

#include "core/error.h"
#include "raytrace/propagation.h"
#include "raytrace/waves/depth_wave.h"
#include "raytrace/waves/wave_integral.h"
#include "support/csv.h"

// The wave equation of stratified water against closed forms, an integrator and independent tables.

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

const ReflectionTable nothing_back{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};

PropagationCase waves_of(const Environment& ocean, double frequency, double source) {
  PropagationCase c;
  c.environment = ocean;
  c.frequency = frequency;
  c.source_depths = {source};
  c.solver = FieldSolver::waves;
  return c;
}

double loss(double intensity) { return -10.0 * std::log10(intensity); }

double at_share(std::vector<double> all, double share) {
  std::sort(all.begin(), all.end());
  return all[std::size_t(share * double(all.size() - 1))];
}

/// u″ = −q(t)·u by 40 000 steps of Runge and Kutta, for what does not grow beyond numbers.
DepthWave by_small_steps(DepthWave wave, Complex from, Complex to, double thickness) {
  constexpr int steps = 40'000;
  const double h = thickness / steps;
  const auto q = [&](double t) { return from + (to - from) * (t / thickness); };
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Complex u = wave.u, v = wave.du, qm = q(t + 0.5 * h), qe = q(t + h);
    const Complex u1 = v, v1 = -q(t) * u, u2 = v + 0.5 * h * v1, v2 = -qm * (u + 0.5 * h * u1);
    const Complex u3 = v + 0.5 * h * v2, v3 = -qm * (u + 0.5 * h * u2);
    const Complex u4 = v + h * v3, v4 = -qe * (u + h * u3);
    wave.u += h / 6.0 * (u1 + 2.0 * (u2 + u3) + u4);
    wave.du += h / 6.0 * (v1 + 2.0 * (v2 + v3) + v4);
  }
  return wave;
}

// Any line of q: far from a turn, through it, short of it, constant, almost so, with losses.
TEST(Waves, ALayerIsFollowedAsTheEquationSays) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1.0, 1.0), loss_of(-12.0, -1.0);
  for (int i = 0; i < 300; ++i) {
    const double scale = std::pow(10.0, part(random));
    const Complex from = scale * Complex(part(random), -std::pow(10.0, loss_of(random)));
    Complex to = scale * Complex(part(random), from.imag() / scale);
    if (i % 5 == 0) to = from;
    if (i % 5 == 1) to = from * 1.0001;
    const double thickness = 40.0 / std::sqrt(scale) * std::abs(part(random));
    const DepthWave start{.u = {part(random), part(random)},
                          .du = std::sqrt(scale) * Complex{part(random), part(random)}};
    DepthWave got = start;
    follow(got, from, to, thickness);
    const DepthWave expected = by_small_steps(start, from, to, thickness);
    const double size = std::abs(expected.u) + std::abs(expected.du) / std::sqrt(scale);
    const double grown = std::exp(got.growth);
    EXPECT_LT(std::abs(got.u * grown - expected.u), 1e-6 * size) << from << to << thickness;
    EXPECT_LT(std::abs(got.du * grown - expected.du), 1e-6 * size * std::sqrt(scale)) << i;
  }
}

// e^700 and more: numbers end, the wave does not.
TEST(Waves, AWaveGrowsBeyondNumbers) {
  DepthWave wave;
  follow(wave, {1.0, -1e-9}, {-9.0, -1e-9}, 2000.0);
  EXPECT_TRUE(std::isfinite(std::abs(wave.u)) && std::abs(wave.u) > 0.0);
  EXPECT_NEAR(wave.growth + std::log(std::abs(wave.u)), 1800.0 * 2.0, 20.0);
}

TEST(Waves, BesselsFunction) {
  for (double x = 0.0; x < 60.0; x += 0.37)
    EXPECT_NEAR(std::abs(bessel_j0(x) - std::cyl_bessel_j(0.0, x)), 0.0, 2e-7) << x;
  // the mean over a turn of e^{iz·cos φ}
  for (const Complex z : {Complex(3.0, 1.0), Complex(13.0, -2.0), Complex(40.0, 0.6)}) {
    Complex mean = 0.0;
    for (int k = 0; k < 400; ++k)
      mean += std::exp(Complex(0.0, 1.0) * z * std::cos(2.0 * pi * k / 400.0)) / 400.0;
    EXPECT_LT(std::abs(bessel_j0(z) - mean), 1e-6 * std::exp(std::abs(z.imag()))) << z;
  }
}

// Water without end: e^{−ikR}/R, near and far, up, down and level.
TEST(Waves, FreeSpace) {
  Environment ocean{.water = SoundSpeedProfile::isovelocity(1500.0),
                    .surface = {.depth = 0.0, .material = nothing_back},
                    .bottom = {.depth = 400.0, .material = nothing_back}};
  PropagationCase c = waves_of(ocean, 300.0, 150.0);
  c.receivers = {.depths = {20.0, 151.0, 380.0},
                 .ranges = {0.0, 20.0, 60.0, 99.0, 101.0, 300.0, 2000.0, 9000.0}};
  const PropagationResult result = run(c);
  ASSERT_TRUE(result.waves);
  const double k = 2.0 * pi * 300.0 / 1500.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < c.receivers.ranges.size(); ++j) {
      const double r = std::hypot(c.receivers.ranges[j], c.receivers.depths[i] - 150.0);
      if (r < 5.0) continue;
      const Complex expected = std::polar(1.0 / r, -k * r);
      const Complex got(result.field[i * c.receivers.ranges.size() + j]);
      EXPECT_LT(std::abs(got - expected), 0.003 / r) << c.receivers.depths[i] << ' ' << r;
    }
}

/// p of a unit source between a vacuum and a rigid floor: −iπ·ΣΨΨH₀⁽²⁾.
Complex ideal_modes(double frequency, double depth, double source, double receiver, double range) {
  const double k = 2.0 * pi * frequency / 1490.0;
  Complex sum = 0.0;
  for (int m = 1; m <= 400; ++m) {
    const double gamma = (m - 0.5) * pi / depth, square = k * k - gamma * gamma;
    const double shape = 2.0 / depth * std::sin(gamma * source) * std::sin(gamma * receiver);
    const double x = std::sqrt(std::abs(square)) * range;
    if (square > 0.0)
      sum +=
          shape * Complex(0.0, -pi) * Complex(std::cyl_bessel_j(0.0, x), -std::cyl_neumann(0.0, x));
    else if (x < 600.0)
      sum += shape * 2.0 * std::cyl_bessel_k(0.0, x);
  }
  return sum;
}

TEST(Waves, IdealGuideIsTheSumOfModes) {
  for (const double frequency : {27.0, 61.0, 250.0}) {
    Environment ocean{.water = SoundSpeedProfile::isovelocity(1490.0),
                      .bottom = {.depth = 110.0, .material = Rigid{}}};
    PropagationCase c = waves_of(ocean, frequency, 40.0);
    c.receivers.depths = {25.0, 65.0};
    for (int i = 0; i <= 240; ++i) c.receivers.ranges.push_back(200.0 + 20.0 * i);
    const PropagationResult result = run(c);
    std::vector<double> off;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < c.receivers.ranges.size(); ++j) {
        const Complex expected =
            ideal_modes(frequency, 110.0, 40.0, c.receivers.depths[i], c.receivers.ranges[j]);
        const Complex got(result.field[i * c.receivers.ranges.size() + j]);
        off.push_back(std::abs(20.0 * std::log10(std::abs(got) / std::abs(expected))));
      }
    EXPECT_LT(at_share(off, 0.95), 0.05) << frequency;
  }
}

// Jensen's guide, by an independent wavenumber integral that includes head waves and the continuum.
// Images with plane-wave coefficients are 0.02 to 0.3 dB off, so waves are the default for such a
// field, too.
TEST(Waves, PekerisGuide) {
  const support::Csv csv("physics-reference/field_pekeris_250Hz.csv");
  Environment ocean{.water = SoundSpeedProfile::isovelocity(1500.0),
                    .water_density = 1000.0,
                    .bottom = {.depth = 200.0, .material = FluidHalfSpace{1700.0, 1800.0, 0.5}}};
  PropagationCase c = waves_of(ocean, 250.0, 50.0);
  c.receivers = {.depths = {100.0, 150.0}, .ranges = csv["range_m"]};
  const PropagationResult result = run(c);
  c.solver = FieldSolver::automatic;
  EXPECT_EQ(run(c).field, result.field);
  std::vector<double> off;
  for (std::size_t j = 0; j < csv.rows(); ++j)
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string at = i == 0 ? "zr100" : "zr150";
      const Complex expected(csv[at + "_re"][j], -csv[at + "_im"][j]);
      const Complex got(result.field[i * csv.rows() + j]);
      off.push_back(std::abs(got - expected) / std::abs(expected));
    }
  EXPECT_LT(at_share(off, 0.95), 0.003);  // 0.03 dB
}

/// The largest |ΔTL| of range means against a table of them.
double worst_window(PropagationCase c, const support::Csv& csv, const std::string& level,
                    double step, double below) {
  std::map<std::pair<double, double>, std::vector<std::size_t>> groups;
  const bool by_depth = c.receivers.depths.empty();
  for (std::size_t i = 0; i < csv.rows(); ++i)
    if (csv[level][i] < below)
      groups[{csv["f_Hz"][i], by_depth ? csv["zr_m"][i] : c.receivers.depths[0]}].push_back(i);
  double worst = 0.0;
  for (const auto& [key, rows] : groups) {
    c.frequency = key.first;
    c.receivers = {.depths = {key.second}};
    std::vector<double>& ranges = c.receivers.ranges;
    const auto places = [&](std::size_t i) {
      std::vector<double> all;
      const double half = csv["half_window_m"][i], middle = csv["range_m"][i];
      for (int k = 0; k * step <= 2.0 * half + 1e-6; ++k) all.push_back(middle - half + k * step);
      return all;
    };
    for (const std::size_t i : rows)
      for (const double r : places(i)) ranges.push_back(r);
    std::sort(ranges.begin(), ranges.end());
    ranges.erase(std::unique(ranges.begin(), ranges.end()), ranges.end());
    const PropagationResult result = run(c);
    EXPECT_TRUE(result.waves);
    for (const std::size_t i : rows) {
      double sum = 0.0;
      const std::vector<double> all = places(i);
      for (const double r : all)
        sum += std::norm(Complex(result.field[std::size_t(
            std::lower_bound(ranges.begin(), ranges.end(), r) - ranges.begin())]));
      worst = std::max(worst, std::abs(loss(sum / double(all.size())) - csv[level][i]));
    }
  }
  return worst;
}

// In the duct and below it, where rays bring nothing: 500 to 3500 Hz.
TEST(Waves, LeakageOutOfASurfaceDuct) {
  const std::vector<double> depth = {0.0, 60.0, 160.0, 360.0, 1000.0, 5000.0};
  const std::vector<double> speed = {1510.0, 1510.96, 1500.96, 1490.96, 1487.76, 1551.76};
  PropagationCase c =
      waves_of({.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear),
                .bottom = {.depth = 5000.0, .material = nothing_back}},
               0.0, 10.0);
  c.solver = FieldSolver::automatic;
  EXPECT_LT(worst_window(c, support::Csv("physics-reference/leakage_duct60_windows.csv"),
                         "TL_ffp_dB", 10.0, 130.0),
            0.1);
}

// Lit, at the edge and up to 2.7 km in the shadow.
TEST(Waves, ShadowOfDownwardRefraction) {
  constexpr double a = 0.2 / 3000.0;
  const std::vector<double> depth = {0.0, 1500.0};
  const std::vector<double> speed = {1500.0, 1500.0 / std::sqrt(1.0 + a * 1500.0)};
  PropagationCase c =
      waves_of({.water = SoundSpeedProfile::table(depth, speed, Interpolation::n2_linear),
                .bottom = {.depth = 1500.0, .material = nothing_back}},
               0.0, 25.0);
  c.solver = FieldSolver::automatic;
  c.receivers.depths = {50.0};
  EXPECT_LT(worst_window(c, support::Csv("physics-reference/leakage_n2_windows.csv"), "TL_dB", 10.0,
                         145.0),
            0.1);
}

// Shadow, caustics and lit zones of Munk's ocean. The table's own two absorbers below 5000 m differ
// by up to 0.3 dB.
TEST(Waves, ConvergenceZones) {
  PropagationCase c = waves_of(
      {.water = SoundSpeedProfile::munk(), .bottom = {.depth = 5000.0, .material = nothing_back}},
      0.0, 1000.0);
  c.solver = FieldSolver::automatic;
  EXPECT_LT(worst_window(c, support::Csv("physics-reference/leakage_munkcz_windows.csv"),
                         "TL_ffp_dB", 50.0, 130.0),
            1.0);
}

// Water that is called a layer of the floor is water: deep water over a fluid, and shallow water
// over a layer of the same water over that fluid.
TEST(Waves, ALayerOfTheFloorMayBeWater) {
  const FluidHalfSpace sand{
      .speed = 1700.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.7};
  const auto field = [&](double depth, const BoundaryMaterial& floor) {
    PropagationCase c = waves_of({.water = SoundSpeedProfile::isovelocity(1500.0),
                                  .surface = {.depth = 0.0, .material = Vacuum{}},
                                  .bottom = {.depth = depth, .material = floor}},
                                 120.0, 20.0);
    c.environment.water_density = DepthFunction(1000.0);
    c.receivers = {.depths = {10.0, 55.0}, .ranges = {30.0, 200.0, 1000.0, 3000.0, 8000.0}};
    return run(c).field;
  };
  const FloorLayer below{.speed = sand.speed,
                         .density = sand.density,
                         .attenuation_db_per_wavelength = sand.attenuation_db_per_wavelength};
  const auto layer_of = [](double thickness) {
    return FloorLayer{.thickness = thickness,
                      .speed = 1500.0,
                      .density = 1000.0,
                      .attenuation_db_per_wavelength = 0.0};
  };
  const auto same = [](const auto& a, const auto& b, double within) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_LT(std::abs(Complex(a[i]) - Complex(b[i])), within * std::abs(Complex(b[i]))) << i;
  };
  same(field(60.0, LayeredFloor{{layer_of(40.0)}, below}), field(100.0, sand), 2e-3);
  same(field(60.0, LayeredFloor{{layer_of(0.0)}, below}), field(60.0, sand), 1e-6);
}

// A spline is no line of 1/c² anywhere: reciprocity, and layers half as thick (that is 2.8 times
// the frequency's worth) change nothing, in a sea over silt with shear and a rough surface.
TEST(Waves, AreReciprocal) {
  const std::vector<double> depth = {0.0, 30.0, 50.0, 80.0, 150.0};
  const std::vector<double> speed = {1520.0, 1521.0, 1500.0, 1495.0, 1497.0};
  Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::pchip),
                    .surface = {.depth = 0.0, .material = Vacuum{}, .roughness = {0.3, -20.0}},
                    .bottom = {.depth = 150.0, .material = ElasticHalfSpace{}}};
  PropagationCase there = waves_of(ocean, 400.0, 20.0), back = waves_of(ocean, 400.0, 120.0);
  there.receivers = {.depths = {120.0}, .ranges = {30.0, 500.0, 3000.0, 12000.0}};
  back.receivers = {.depths = {20.0}, .ranges = there.receivers.ranges};
  const auto a = run(there).field, b = run(back).field;
  for (std::size_t j = 0; j < a.size(); ++j)
    EXPECT_LT(std::abs(a[j] - b[j]), 1e-4F * std::abs(a[j])) << j;
}

TEST(Waves, ScatteredReceiversAreThoseOfTheGrid) {
  Environment ocean{.water = SoundSpeedProfile::munk(),
                    .bottom = {.depth = 3000.0, .material = FluidHalfSpace{}}};
  PropagationCase grid = waves_of(ocean, 40.0, 700.0);
  grid.receivers = {.depths = {100.0, 900.0, 3200.0}, .ranges = {0.0, 400.0, 5000.0, 20000.0}};
  PropagationCase scattered = grid;
  scattered.receivers = {
      .depths = {900.0, 100.0, 3200.0}, .ranges = {20000.0, 400.0, 5000.0}, .irregular = true};
  const auto a = run(grid).field, b = run(scattered).field;
  EXPECT_EQ(b[0], a[7]);
  EXPECT_EQ(b[1], a[1]);
  EXPECT_EQ(b[2], std::complex<float>(0.0F));  // under the bottom
}

// What is left out is told, in one line.
TEST(Waves, RaysSayWhatTheyLeaveOut) {
  Environment ocean{.water = SoundSpeedProfile::munk(),
                    .bottom = {.depth = 5000.0, .material = nothing_back}};
  PropagationCase c = waves_of(ocean, 3000.0, 700.0);
  c.solver = FieldSolver::automatic;
  c.receivers = {.depths = {100.0}, .ranges = {50000.0, 200000.0}};
  const PropagationResult dear = run(c);
  EXPECT_FALSE(dear.waves);
  EXPECT_THAT(dear.notes, testing::Contains(testing::HasSubstr("solver = \"waves\" takes them")));
  c.frequency = 50.0;
  PropagationCase many = c;  // each of them a depth and a range of its own
  many.receivers.irregular = true;
  many.receivers.depths.clear();
  many.receivers.ranges.clear();
  for (int i = 0; i < 12'000; ++i) {
    many.receivers.depths.push_back(100.0 + 0.1 * i);
    many.receivers.ranges.push_back(500.0 + i);
  }
  many.solver = FieldSolver::waves;
  EXPECT_THROW(run(many), InputError);
  c.beams.highest = 0.3;
  EXPECT_THAT(run(c).notes, testing::Contains(testing::HasSubstr("since the fan is limited")));
  c.solver = FieldSolver::waves;
  EXPECT_THROW(run(c), InputError);
  c.solver = FieldSolver::beams;
  for (const std::string& note : run(c).notes) EXPECT_EQ(note.find("left out"), note.npos) << note;
}

TEST(Waves, AreTheSameBitsForAnyNumberOfThreads) {
  PropagationCase c = waves_of({.water = SoundSpeedProfile::munk()}, 100.0, 700.0);
  c.receivers = {.depths = {50.0, 800.0}, .ranges = {300.0, 20000.0, 50000.0}};
  const auto on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run(c).field;
  };
  EXPECT_EQ(on(1), on(5));
}

TEST(Waves, StopWhenTold) {
  PropagationCase c = waves_of({.water = SoundSpeedProfile::munk()}, 100.0, 700.0);
  c.receivers = {.depths = {100.0}, .ranges = {50000.0}};
  EXPECT_THROW(run(c, [](double) { return false; }), Interrupted);
}

}  // namespace
}  // namespace asdic::detail
