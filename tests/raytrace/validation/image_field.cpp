#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "raytrace/propagation.h"

// Fields by images against modes, closed forms and plain long sums.

namespace asdic::detail {
namespace {

/// The guide of 110 m and 27 Hz over a rigid floor.
PropagationCase ideal_guide() {
  PropagationCase c;
  c.frequency = 27.0;
  c.environment.water = SoundSpeedProfile::isovelocity(1490.0);
  c.environment.water_density = 1000.0;
  c.environment.bottom = {.depth = 110.0, .material = Rigid{}};
  c.source_depths = {40.0};
  c.receivers.depths = {25.0, 65.0};
  for (int i = 0; i <= 240; ++i) c.receivers.ranges.push_back(200.0 + 20.0 * i);
  return c;
}

/// p of a unit source, e^{+iωt}: −iπ·Σ Ψ(z_s)Ψ(z)H₀⁽²⁾(k_m r), Ψ = √(2/D) sin γz, γ = (m − ½)π/D.
std::complex<double> modes(const PropagationCase& c, double range, double depth) {
  const double D = c.environment.bottom.depth, k = 2.0 * pi * c.frequency / 1490.0;
  std::complex<double> sum = 0.0;
  for (int m = 1; m <= 400; ++m) {
    const double gamma = (m - 0.5) * pi / D, square = k * k - gamma * gamma;
    const double shape = 2.0 / D * std::sin(gamma * c.source_depths[0]) * std::sin(gamma * depth);
    const double x = std::sqrt(std::abs(square)) * range;
    if (square > 0.0)
      sum += shape * std::complex<double>(0.0, -pi) *
             std::complex<double>(std::cyl_bessel_j(0.0, x), -std::cyl_neumann(0.0, x));
    else if (x < 600.0)
      sum += shape * 2.0 * std::cyl_bessel_k(0.0, x);
  }
  return sum;
}

double level(std::complex<double> p) { return 20.0 * std::log10(std::abs(p)); }

double at_share(std::vector<double> all, double share) {
  std::sort(all.begin(), all.end());
  return all[std::size_t(share * double(all.size() - 1))];
}

// A rigid floor and a vacuum lose nothing: the sum of images has no end and converges only because
// their signs change. float32 results are right to 1e-6 of their own size.
TEST(ImageField, IdealGuideIsTheSumOfModes) {
  for (const double frequency : {27.0, 61.0, 250.0}) {
    PropagationCase c = ideal_guide();
    c.frequency = frequency;
    const PropagationResult result = run(c);
    EXPECT_EQ(result.beams, 0U);
    ASSERT_EQ(result.notes.size(), 1U);
    EXPECT_NE(result.notes[0].find("images of the source"), std::string::npos);
    std::vector<double> off;
    for (std::size_t row = 0; row < 2; ++row)
      for (std::size_t j = 0; j < c.receivers.ranges.size(); ++j) {
        const auto p = std::complex<double>(result.field[row * c.receivers.ranges.size() + j]);
        const auto exact = modes(c, c.receivers.ranges[j], c.receivers.depths[row]);
        off.push_back(std::abs(level(p) - level(exact)));
      }
    EXPECT_LT(at_share(off, 0.95), 1e-3) << frequency;
    EXPECT_LT(at_share(off, 1.0), 0.02) << frequency;
    EXPECT_LT(result.beam_error_db, 1e-3);
  }
}

// Σ 1/(r² + (2kD + d)²) over all k = π/(2Dr)·sinh(πr/D)/(cosh(πr/D) − cos(πd/D)), for d = z − z_s
// and z + z_s.
TEST(ImageField, IncoherentIdealGuideIsTheClosedForm) {
  PropagationCase c = ideal_guide();
  c.field = FieldKind::incoherent;
  c.receivers.ranges = {5.0, 50.0, 200.0, 3000.0};
  const PropagationResult result = run(c);
  const double D = c.environment.bottom.depth;
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t j = 0; j < 4; ++j) {
      const double r = c.receivers.ranges[j], x = pi * r / D, z = c.receivers.depths[row];
      double sum = 0.0;
      for (const double d : {z - c.source_depths[0], z + c.source_depths[0]})  // over cosh x
        sum += pi / (2.0 * D * r) * std::tanh(x) / (1.0 - std::cos(pi * d / D) / std::cosh(x));
      EXPECT_NEAR(level(std::complex<double>(result.field[row * 4 + j])), 10.0 * std::log10(sum),
                  1e-4);
    }
}

/// A plain sum over images up to a shell, without any rule for its end.
std::complex<double> plain(const PropagationCase& c, double range, double depth, int shells) {
  const Environment& ocean = c.environment;
  const double D = ocean.bottom.depth, speed = ocean.water.at(0.0).c, zs = c.source_depths[0];
  const double k = 2.0 * pi * c.frequency / speed;
  const double alpha = attenuation_np_per_m(ocean, c.frequency).at(0.0);
  const WaterAtBoundary water{speed, ocean.water_density.at(0.0)};
  std::complex<double> sum = 0.0;
  for (int n = -shells; n <= shells; ++n)
    for (const bool mirrored : {false, true}) {
      const double rise = 2.0 * n * D + (mirrored ? -depth : depth) - zs;
      const int bottom = std::abs(n), surface = !mirrored ? bottom : n > 0 ? n - 1 : 1 - n;
      const double R = std::hypot(range, rise), grazing = std::atan2(std::abs(rise), range);
      const double elevation = -std::atan2(rise, range);
      if (elevation < c.beams.lowest || elevation > c.beams.highest) continue;
      double amplitude =
          c.beams.source == SourceKind::point ? 1.0 / R : 4.0 * std::sqrt(pi) / std::sqrt(R);
      if (c.beams.pattern) amplitude *= c.beams.pattern->at(elevation);
      if (c.field == FieldKind::semi_coherent)
        amplitude *= std::sqrt(2.0) * std::abs(std::sin(k * zs * std::sin(elevation)));
      const auto p =
          amplitude * std::exp(-alpha * R) *
          std::pow(reflection_coefficient(ocean.surface.material, grazing, water), surface) *
          std::pow(reflection_coefficient(ocean.bottom.material, grazing, water), bottom) *
          std::polar(1.0, -k * R);
      sum += c.field == FieldKind::coherent ? p : std::complex<double>(std::norm(p));
    }
  return c.field == FieldKind::coherent ? sum : std::sqrt(sum.real());
}

// Any walls, sources and sums: the rule for the end leaves out no more than it says.
TEST(ImageField, IsThePlainSumOverManyImages) {
  const BoundaryMaterial floors[] = {
      FluidHalfSpace{.speed = 1650.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.5},
      FluidHalfSpace{.speed = 1450.0, .density = 1300.0, .attenuation_db_per_wavelength = 0.0},
      ElasticHalfSpace{}, Rigid{}, Vacuum{}};
  for (const BoundaryMaterial& floor : floors)
    for (const FieldKind kind :
         {FieldKind::coherent, FieldKind::incoherent, FieldKind::semi_coherent})
      for (const SourceKind source : {SourceKind::point, SourceKind::line}) {
        PropagationCase c = ideal_guide();
        c.frequency = 180.0;
        c.field = kind;
        c.environment.bottom.material = floor;
        c.environment.absorption = Thorp{};
        c.beams.source = source;
        // without an end for the plain sum, a fan that has one
        if (std::abs(reflection_coefficient(floor, 0.5 * pi, {1490.0, 1000.0})) > 0.99) {
          c.beams.lowest = radians(-80.0);
          c.beams.highest = radians(70.0);
        } else {
          c.beams.pattern = SourcePattern{{-1.0, 0.0, 1.0}, {0.6, 1.0, 0.7}};
        }
        c.receivers = {.depths = {0.0, 33.0, 110.0}, .ranges = {0.0, 90.0, 1000.0, 9000.0}};
        const PropagationResult result = run(c);
        EXPECT_EQ(result.beams, 0U);
        for (std::size_t i = 0; i < result.field.size(); ++i) {
          const double r = std::max(c.receivers.ranges[i % 4], 0.1), z = c.receivers.depths[i / 4];
          const auto expected = plain(c, r, z, 1500);
          EXPECT_NEAR(std::abs(std::complex<double>(result.field[i]) - expected), 0.0,
                      1e-4 * std::abs(expected) + 1e-7)
              << i << ' ' << floor.index() << ' ' << int(kind) << ' ' << int(source);
        }
      }
}

// A row that rounding has a little below the bottom is on it; one further off is in no water.
TEST(ImageField, ReachesReceiversOnTheBottom) {
  PropagationCase c = ideal_guide();
  c.environment.bottom.material = FluidHalfSpace{};
  const double bottom = c.environment.bottom.depth;
  c.receivers = {.depths = {bottom, bottom + 1e-9, bottom + 1.0}, .ranges = {900.0}};
  const auto field = run(c).field;
  EXPECT_GT(std::abs(field[0]), 0.0F);
  EXPECT_NEAR(std::abs(field[1] - field[0]), 0.0F, 1e-5F * std::abs(field[0]));
  EXPECT_EQ(std::abs(field[2]), 0.0F);
}

// Images where the beams' limit is not the sum of paths, or the water no guide, would be wrong.
TEST(ImageField, IsChosenOnlyWhereItIsTheBeamsLimit) {
  const auto beams_of = [](auto&& change) {
    PropagationCase c = ideal_guide();
    c.environment.bottom.material = FluidHalfSpace{};
    c.receivers.ranges = {300.0, 900.0};
    change(c);
    return run(c).beams;
  };
  EXPECT_EQ(beams_of([](auto&) {}), 0U);
  EXPECT_EQ(beams_of([](auto& c) { c.beams.kind = BeamKind::ray_centred_hat; }), 0U);
  EXPECT_GT(beams_of([](auto& c) { c.beams.kind = BeamKind::gaussian; }), 0U);
  EXPECT_GT(beams_of([](auto& c) { c.beams.elevations = {-0.1, 0.0, 0.1}; }), 0U);
  EXPECT_GT(beams_of([](auto& c) { c.beams.displacement = true; }), 0U);
  EXPECT_GT(beams_of([](auto& c) { c.box_depth = 90.0; }), 0U);
  PropagationCase refracting = ideal_guide();  // paths, but no images
  refracting.environment.bottom.material = FluidHalfSpace{};
  refracting.receivers.ranges = {300.0, 900.0};
  const double z[] = {0.0, 110.0}, v[] = {1490.0, 1491.0};
  refracting.environment.water = SoundSpeedProfile::table(z, v, Interpolation::c_linear);
  const PropagationResult result = run(refracting);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("stratified water"), std::string::npos) << result.notes[0];
}

// Images have no head wave and no displacement of a beam, so waves are preferred where they are
// allowed, unless the walls reflect all angles alike. If images replace waves, the note says what
// it bounds.
TEST(ImageField, GivesWayToWavesWhereAFloorDoesNotMirror) {
  PropagationCase c = ideal_guide();
  c.solver = FieldSolver::automatic;
  EXPECT_FALSE(run(c).waves);
  c.environment.bottom.material = FluidHalfSpace{};
  EXPECT_TRUE(run(c).waves);
  c.solver = FieldSolver::beams;
  const PropagationResult images = run(c);
  EXPECT_FALSE(images.waves);
  ASSERT_EQ(images.notes.size(), 1U);
  EXPECT_NE(images.notes[0].find("images left out are"), std::string::npos);
  EXPECT_NE(images.notes[0].find("as plane waves are"), std::string::npos);
  c.solver = FieldSolver::automatic;
  c.frequency = 2e4;
  c.receivers.ranges = {3e5};  // 6e6 wavenumbers and at least four layers
  const PropagationResult dear = run(c);
  EXPECT_FALSE(dear.waves);
  ASSERT_EQ(dear.notes.size(), 2U);
  EXPECT_NE(dear.notes[1].find("takes them"), std::string::npos);
}

}  // namespace
}  // namespace asdic::detail
