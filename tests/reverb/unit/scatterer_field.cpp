#include "reverb/fields/scatterer_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <set>
#include <vector>

#include "core/mixed_bits.h"
#include "core/settings_words.h"
#include "reverb/scattering/models.h"
#include "reverb/scattering/motion.h"

namespace asdic::detail {
namespace {

constexpr int many = 40'000;

/// ⟨w(t) w*(t′)⟩ over many scatterers.
double correlation(double coherence_time, double t, double later) {
  const ScattererStatistics statistics{.coherence_time = coherence_time};
  const ScattererWeights a(statistics, Draw::surface_weight, 5, t, 1);
  const ScattererWeights b(statistics, Draw::surface_weight, 5, later, 2);
  std::complex<double> sum = 0.0;
  for (std::uint64_t entity = 0; entity < many; ++entity)
    sum += a(mixed(entity, 1)) * std::conj(b(mixed(entity, 1)));
  return (sum / double(many)).real();
}

// Of 40 000 scatterers: ± 1/√40 000 = 0.005, 4.9 sigma 0.025; the ripple of the moving average is
// 5e-4. Far from a node, between nodes, before the scenario starts.
TEST(ScattererWeights, CorrelationIsTheLaw) {
  for (const double t : {0.0, 3.1, -40.0, 5e5}) {
    EXPECT_NEAR(correlation(10.0, t, t), 1.0, 0.025) << t;
    for (const double lag : {2.0, 5.0, 10.0, 17.0})
      EXPECT_NEAR(correlation(10.0, t, t + lag), std::exp(-lag * lag / 100.0), 0.025) << t << lag;
    EXPECT_NEAR(correlation(10.0, t, t + 60.0), 0.0, 0.025);
  }
  EXPECT_NEAR(correlation(0.0, 1.0, 1.0), 0.0, 0.025);  // other pings
  EXPECT_NEAR(correlation(infinity, 1.0, 1e6), 1.0, 0.025);
}

// Mean 1 and variance 1/ν of the power; 20 000 squares: the mean to 4.9·√(1/ν/20 000), the variance
// to 15 % (a gamma variate's fourth moment: (2 + 6/ν)/n, 4.9 sigma 0.14 at ν = 0.5).
TEST(ScattererTexture, PowerIsGammaDistributed) {
  for (const double shape : {0.5, 1.0, 4.0}) {
    const ScattererStatistics statistics{.k_shape = shape, .correlation_length = 100.0};
    double sum = 0.0, squares = 0.0;
    constexpr int n = 20'000;
    for (int i = 0; i < n; ++i) {
      const double power =
          std::pow(texture_amplitude(
                       statistics, Vec2(100.0 * (i % 200) + 50.0, 100.0 * (i / 200) - 50.0), 1, 9),
                   2.0);
      sum += power;
      squares += power * power;
    }
    const double mean = sum / n, variance = squares / n - mean * mean;
    EXPECT_NEAR(mean, 1.0, 4.9 * std::sqrt(1.0 / shape / n)) << shape;
    EXPECT_NEAR(variance * shape, 1.0, 0.15) << shape;
    // Each square has one texture. Of pairs of places a metre apart 1 in 100 has a side between
    // them (of 200 pairs at most 9, except once in 10⁶); of pairs 100 m apart all have.
    int apart = 0;
    for (int i = 0; i < 200; ++i) {
      const double x = 37.0 * i, here = texture_amplitude(statistics, Vec2(x, 20.0), 1, 9);
      if (texture_amplitude(statistics, Vec2(x + 1.0, 20.0), 1, 9) != here) ++apart;
      EXPECT_NE(texture_amplitude(statistics, Vec2(x + 100.0, 20.0), 1, 9), here);
    }
    EXPECT_LE(apart, 9);
    // The map's [0, 0] is not a corner. Its place in its square depends on the seed, so that 1 seed
    // in 50 has one of two sides within a metre (of 300 at most 20, except once in 10⁶).
    int corners = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed)
      if (texture_amplitude(statistics, Vec2(-0.5, -0.5), 1, seed) !=
          texture_amplitude(statistics, Vec2(0.5, 0.5), 1, seed))
        ++corners;
    EXPECT_LE(corners, 20);
  }
  EXPECT_EQ(texture_amplitude({}, Vec2(1.0, 2.0), 1, 9), 1.0);
}

// In its cell, and together the areas of a ring are its area.
TEST(ScattererPlaces, LieInTheirCells) {
  const ScattererGrid grid{.anchor = {100.0, -50.0},
                           .identity = 77,
                           .spacing = 20.0,
                           .azimuths = 12,
                           .first_bearing = 0.3,
                           .rings = 10};
  double area = 0.0;
  for (std::uint32_t sector = 0; sector < 12; ++sector)
    for (std::uint32_t copy = 0; copy < 4; ++copy) {
      const ScattererKey key{.ring = 7, .sector = sector, .copies = 4, .copy = copy};
      const Scatterer s = place_scatterer(grid, key, key.entity(grid.identity), 3);
      const Vec2 way = s.place - grid.anchor;
      EXPECT_GE(way.norm(), 140.0 - 1e-9);
      EXPECT_LE(way.norm(), 160.0 + 1e-9);
      double turns = (std::atan2(way.x(), way.y()) - 0.3) / (2.0 * pi);
      turns -= std::floor(turns);
      EXPECT_EQ(static_cast<std::uint32_t>(turns * 48.0), 4 * sector + copy);
      area += s.area;
    }
  EXPECT_NEAR(area, pi * (160.0 * 160.0 - 140.0 * 140.0), 1e-6);
}

constexpr double pitch = 100.0;

std::vector<Anchor> around(const Vec2& moved, bool blended = true) {
  const Vec2 first(10.0, 20.0);
  return anchors_of(first, first + moved, 0.0, Vec2::Zero(), pitch, 1, blended);
}

TEST(ScattererAnchor, StaysThenMovesByAWholePitch) {
  const Anchor start = around(Vec2::Zero()).front();
  EXPECT_EQ(start.place, Vec2(10.0, 20.0));
  for (const bool blended : {false, true}) {
    const Anchor near = around({44.0, -44.0}, blended).front();
    EXPECT_EQ(near.identity, start.identity);
    EXPECT_EQ(near.place, start.place);
    EXPECT_EQ(near.share, 1.0);
    const Anchor far = around({56.0, 0.0}, blended).front();
    EXPECT_NE(far.identity, start.identity);
    EXPECT_EQ(far.place, Vec2(110.0, 20.0));
  }
  EXPECT_EQ(around({49.0, -49.0}, false).size(), 1U);
  // Who drifts with the water stays where she is in it.
  const Vec2 first(10.0, 20.0);
  const Anchor drifting =
      anchors_of(first, first + Vec2(400.0, 0.0), 200.0, Vec2(2.0, 0.0), pitch, 1, true).front();
  EXPECT_EQ(drifting.identity, start.identity);
  EXPECT_EQ(drifting.place, first + Vec2(400.0, 0.0));
}

/// ⟨p p′*⟩ of the seas that two pairs of ends receive: Σ share·share′ over the anchors they share.
double common_sea(const Vec2& here, const Vec2& there) {
  double sum = 0.0;
  for (const Anchor& a : around(here))
    for (const Anchor& b : around(there))
      if (a.identity == b.identity) sum += a.share * b.share;
  return sum;
}

// Power 1 everywhere, and pairs d apart along an axis have cos(½π·d/strip) or more of their sea in
// common, strip = 10 m, wherever they are: on a border, in a corner, where a strip begins. (The law
// of a partition cos α, sin α: cos(α − α′) inside the strip.)
TEST(ScattererAnchor, OneSeaGoesOverIntoTheNext) {
  for (const Vec2& middle : {Vec2(0, 0), Vec2(50, 0), Vec2(-50, 50), Vec2(150, -250)})
    for (double x = -6.0; x < 6.0; x += 0.37)
      for (double y = -6.0; y < 6.0; y += 0.41) {
        const Vec2 here = middle + Vec2(x, y);
        EXPECT_NEAR(common_sea(here, here), 1.0, 1e-12);
        for (const double d : {0.5, 2.0}) {
          EXPECT_GE(common_sea(here, here + Vec2(d, 0.0)), std::cos(0.05 * pi * d) - 1e-12);
          EXPECT_GE(common_sea(here, here + Vec2(0.0, d)), std::cos(0.05 * pi * d) - 1e-12);
        }
      }
  EXPECT_EQ(common_sea({40.0, 0.0}, {60.0, 0.0}), 0.0);
  EXPECT_EQ(around({50.0, 50.0}).size(), 4U);
}

// Mean ½ and variance 1/12, and a hundredth of all below 0.01: five standard deviations of 10⁵
// draws. The bits that no draw leaves out end within (0, 1].
TEST(UniformOfBits, IsUniform) {
  constexpr int draws = 100'000;
  double sum = 0.0, squares = 0.0;
  int low = 0;
  for (std::uint64_t i = 0; i < draws; ++i) {
    const double u = uniform_of_bits(mixed(42, i));
    sum += u;
    squares += (u - 0.5) * (u - 0.5);
    low += u < 0.01 ? 1 : 0;
  }
  EXPECT_NEAR(sum / draws, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / draws));
  EXPECT_NEAR(squares / draws, 1.0 / 12.0, 5.0 * std::sqrt(1.0 / 180.0 / draws));
  EXPECT_NEAR(low / double(draws), 0.01, 5.0 * std::sqrt(0.01 * 0.99 / draws));
  EXPECT_EQ(uniform_of_bits(0), 0x1p-54);
  EXPECT_EQ(uniform_of_bits(~std::uint64_t{0}), 1.0);
}

TEST(BottomScattering, LawsAtKnownAngles) {
  const ScatterGeometry backscatter{.grazing_in = radians(30.0), .grazing_out = radians(30.0)};
  EXPECT_NEAR(db_from_power(Lambert{}.cross_section(backscatter, 1000.0)),
              -27.0 + 20.0 * std::log10(0.5), 1e-9);
  // At the specular angle ΔΩ = 0: μ sin²θ + ν. Straight down, likewise.
  const EllisCrowe law{};
  const ScatterGeometry specular{
      .grazing_in = radians(30.0), .grazing_out = radians(30.0), .azimuth = 0.0};
  EXPECT_NEAR(law.cross_section(specular, 1000.0),
              0.25 * power_from_db(-27.0) + power_from_db(-15.0), 1e-15);
  // Backscatter at 70°: ΔΩ = cot²70°.
  const double slope2 = std::pow(std::tan(radians(20.0)), 2.0), s = std::tan(radians(10.0));
  const ScatterGeometry steep{.grazing_in = radians(70.0), .grazing_out = radians(70.0)};
  EXPECT_NEAR(
      law.cross_section(steep, 1000.0),
      power_from_db(-27.0) * std::pow(std::sin(radians(70.0)), 2.0) +
          power_from_db(-15.0) * std::pow(1.0 + slope2, 2.0) * std::exp(-slope2 / (2.0 * s * s)),
      1e-12);
  // The thin sheet: per area, whatever the angles.
  EXPECT_NEAR(db_from_power(VolumeSheet{.strength_db = -70.0, .thickness = 10.0}.cross_section(
                  backscatter, 1000.0)),
              -60.0, 1e-9);
}

// 4 kHz at 1500 m/s and 10°: Q = 2k·cos θ = 33.0 rad/m, √(gQ)/2π = 2.86 Hz.
TEST(SeaMotion, BraggShiftIsThatOfTheWave) {
  const double xi = std::cos(radians(10.0)) / 1500.0;
  const double q = scattering_wavenumber(Vec2(xi, 0.0), Vec2(-xi, 0.0), 4000.0);
  EXPECT_NEAR(q, 2.0 * 2.0 * pi * 4000.0 / 1500.0 * std::cos(radians(10.0)), 1e-9);
  EXPECT_NEAR(bragg_shift(q), 2.863, 0.001);
  EXPECT_EQ(scattering_wavenumber(Vec2(xi, 0.0), Vec2(xi, 0.0), 4000.0), 0.0);  // forward
}

// What a file could say otherwise, a walker sees otherwise.
TEST(ScattererSettings, AreResolvedByWhatTheyDescribe) {
  using Kind = ScattererMotion::Kind;
  const std::vector<ScattererMotion> motions = {{},
                                                {.current = {0.0, 1.0}},
                                                {.kind = Kind::bragg},
                                                {.kind = Kind::bragg, .receding_share = 0.4},
                                                {.kind = Kind::spread},
                                                {.kind = Kind::spread, .speed_rms = 0.1}};
  const std::vector<ScattererStatistics> statistics = {
      {},
      {.coherence_time = 2.0},
      {.coherence_time = infinity},
      {.k_shape = 1.0},
      {.k_shape = 1.0, .correlation_length = 400.0}};
  std::set<std::vector<std::uint64_t>> of_motion, of_statistics;
  for (const ScattererMotion& motion : motions) of_motion.insert(settings_words(motion));
  for (const ScattererStatistics& one : statistics) of_statistics.insert(settings_words(one));
  EXPECT_EQ(of_motion.size(), motions.size());
  EXPECT_EQ(of_statistics.size(), statistics.size());
  // A walker that only looks leaves them alone.
  EXPECT_EQ(statistics[1].coherence_time, 2.0);
  EXPECT_EQ(statistics[2].coherence_time, infinity);
}

}  // namespace
}  // namespace asdic::detail
