#include "raytrace/ocean/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/units.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {
namespace {

TEST(Environment, LossIsTheSumOfLawLayersAndTable) {
  Environment ocean;
  ocean.absorption = Thorp{};
  const double thorp = 1e-3 * absorption_db_per_km(Thorp{}, 2000.0) / db_per_neper;
  const DepthFunction uniform = attenuation_np_per_m(ocean, 2000.0);
  EXPECT_TRUE(uniform.is_constant());
  EXPECT_DOUBLE_EQ(uniform.at(100.0), thorp);

  // Two layers that overlap from 80 to 100 m, over a loss that grows from the surface to 200 m.
  const std::vector<double> depth = {0.0, 200.0}, loss = {0.0, 2.0};
  ocean.attenuation_db_per_km = DepthFunction::table(depth, loss);
  const BiologicalLayer herring{.top = 50.0, .bottom = 100.0, .strength = 1.0};
  const BiologicalLayer lanternfish{.top = 80.0, .bottom = 300.0, .strength = 0.5};
  ocean.biology = {herring, lanternfish};
  const DepthFunction all = attenuation_np_per_m(ocean, 2000.0);
  const auto expected = [&](double z) {
    double db_per_km = absorption_db_per_km(Thorp{}, 2000.0) + ocean.attenuation_db_per_km.at(z);
    if (z >= 50.0 && z < 100.0) db_per_km += absorption_db_per_km(herring, 2000.0);
    if (z >= 80.0 && z < 300.0) db_per_km += absorption_db_per_km(lanternfish, 2000.0);
    return 1e-3 * db_per_km / db_per_neper;
  };
  for (const double z : {-5.0, 0.0, 20.0, 49.999, 50.0, 79.0, 80.0, 99.0, 100.0, 150.0, 200.0,
                         250.0, 299.999, 300.0, 4000.0})
    EXPECT_NEAR(all.at(z), expected(z), 1e-15) << z;
  EXPECT_NEAR(all.just_above(50.0), expected(50.0 - 1e-9), 1e-13);
}

TEST(Environment, LayeredMeansThatOnlyDepthMatters) {
  EXPECT_TRUE(is_layered(Environment{}));
  const std::vector<double> r = {0.0, 1e3}, z = {0.0, 100.0}, c = {1500.0, 1490.0, 1490.0, 1480.0};
  Environment ocean;
  const std::vector<double> density = {1020.0, 1030.0};
  ocean.water_density = DepthFunction::table(z, density);
  EXPECT_TRUE(is_layered(ocean));
  Environment front = ocean;
  front.section.emplace(r, z, c);
  EXPECT_FALSE(is_layered(front));
  Environment slope = ocean;
  slope.bottom.shape.emplace(r, z, ShapeInterpolation::piecewise_linear);
  EXPECT_FALSE(is_layered(slope));
  Environment swell = ocean;
  swell.surface.shape.emplace(r, z, ShapeInterpolation::smooth);
  EXPECT_FALSE(is_layered(swell));
  Environment fish = ocean;
  fish.biology = {BiologicalLayer{}};
  EXPECT_FALSE(is_layered(fish));
  Environment murky = ocean;
  murky.attenuation_db_per_km = DepthFunction::table(z, z);
  EXPECT_FALSE(is_layered(murky));
}

TEST(Environment, TheSectionRulesWhereThereIsOne) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::munk();
  const SoundSpeed munk = SoundSpeedProfile::munk().at(700.0);
  const SoundSpeed2D here = sound_speed(ocean, 1e4, 700.0);
  EXPECT_EQ(here.c, munk.c);
  EXPECT_EQ(here.c_z, munk.dc_dz);
  EXPECT_EQ(here.c_zz, munk.d2c_dz2);
  EXPECT_EQ(here.c_r, 0.0);
  const std::vector<double> r = {0.0, 1e4}, z = {0.0, 1000.0}, c = {1500.0, 1490.0, 1490.0, 1480.0};
  ocean.section.emplace(r, z, c);
  EXPECT_EQ(sound_speed(ocean, 5e3, 500.0).c, 1490.0);
  EXPECT_EQ(sound_speed(ocean, 5e3, 500.0).c_r, -1e-3);
}

// Resonance: a₀·Q² at f₀; the layer's a₀/(1 + 1/Q²) far above it; nothing far below.
TEST(BiologicalLayer, ResonatesAtItsFrequency) {
  const BiologicalLayer fish{.resonance = 1000.0, .quality = 5.0, .strength = 0.2};
  EXPECT_NEAR(absorption_db_per_km(fish, 1000.0), 0.2 * 25.0, 1e-13);
  EXPECT_NEAR(absorption_db_per_km(fish, 1e9), 0.2 / 1.04, 1e-9);
  EXPECT_NEAR(absorption_db_per_km(fish, 2000.0), 0.2 / (0.75 * 0.75 + 0.04), 1e-14);
  EXPECT_LT(absorption_db_per_km(fish, 1.0), 1e-9);
  EXPECT_EQ(absorption_db_per_km(fish, 0.0), 0.0);
}

TEST(SourcePattern, IsLinearInAmplitudeAndGoesOnBeyondItsEnds) {
  const SourcePattern pattern{.elevation = {-0.2, 0.0, 0.1}, .amplitude = {0.5, 1.0, 0.8}};
  EXPECT_DOUBLE_EQ(pattern.at(-0.1), 0.75);
  EXPECT_DOUBLE_EQ(pattern.at(0.0), 1.0);
  EXPECT_DOUBLE_EQ(pattern.at(0.05), 0.9);
  EXPECT_DOUBLE_EQ(pattern.at(-0.4), 0.0);
  EXPECT_DOUBLE_EQ(pattern.at(0.2), 0.6);
  EXPECT_EQ((SourcePattern{.elevation = {0.3}, .amplitude = {0.7}}.at(-1.0)), 0.7);
}

}  // namespace
}  // namespace asdic::detail
