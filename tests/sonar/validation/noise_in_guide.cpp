// Where the noise of the surface comes from in a guide: against plain counts of bounces.
#include "sonar/noise/noise_in_guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sonar/noise/ambient_noise.h"
#include "sonar/noise/noise_coherence.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

/// Straight in dB between what is given.
double level_at(const NoiseDirections& noise, double elevation) {
  const auto& e = noise.elevation;
  const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::upper_bound(e.begin(), e.end(), elevation) - e.begin(), 1,
                                 static_cast<std::ptrdiff_t>(e.size()) - 1));
  return std::lerp(noise.level_db[i - 1], noise.level_db[i],
                   (elevation - e[i - 1]) / (e[i] - e[i - 1]));
}

Environment guide(double attenuation_db_per_km) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.water_density = 1000.0;
  ocean.attenuation_db_per_km = attenuation_db_per_km;
  ocean.bottom = {.depth = 100.0,
                  .material = FluidHalfSpace{
                      .speed = 1700.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.5}};
  return ocean;
}

/// |R_b|² of that floor by Rayleigh's formula.
double floor_of(double grazing, double c = 1500.0) {
  const std::complex<double> n = c / 1700.0 * std::complex<double>(1.0, -0.5 / 54.575);
  const std::complex<double> s = std::sqrt(n * n - std::pow(std::cos(grazing), 2));
  const std::complex<double> down = s.imag() > 0.0 ? -s : s;
  return std::norm((2.0 * std::sin(grazing) - down) / (2.0 * std::sin(grazing) + down));
}

// A ray that has come k times off the floor has travelled z + 2kD from the surface, or 2kD − z if
// it comes from below: the sum of all of them, bounce by bounce.
TEST(NoiseInAGuide, IsThePlainCountOfBounces) {
  constexpr double depth = 30.0, nepers_per_db = 0.115129254649702;
  for (const double attenuation : {0.0, 1.0})
    for (const double m : {0.5, 1.0, 2.0}) {
      const NoiseDirections found = surface_noise(guide(attenuation), depth, m, 1000.0);
      const auto counted = [&](double elevation) {
        const double sine = std::sin(std::abs(elevation)), kept = floor_of(std::abs(elevation));
        const double alpha = attenuation * nepers_per_db * 1e-3;
        double sum = 0.0;
        for (int k = elevation < 0.0 ? 1 : 0; k < 20000; ++k) {
          const double rise = elevation < 0.0 ? 200.0 * k - depth : 200.0 * k + depth;
          sum += std::pow(kept, k) * std::exp(-2.0 * alpha * rise / sine);
        }
        return 10.0 * std::log10(std::pow(sine, 2.0 * m - 1.0) * sum);
      };
      for (const double deg : {-80.0, -40.0, -29.0, -20.0, -5.0, 3.0, 17.0, 27.0, 28.5, 50.0, 89.0})
        EXPECT_NEAR(level_at(found, radians(deg)), counted(radians(deg)), 0.2)
            << attenuation << ' ' << m << ' ' << deg;
      EXPECT_LT(found.elevation.size(), 250U);
    }
}

// Refracting water: sin θ_s of the ray at the surface, |R_b|² of its angle at the floor; rays that
// turn below the surface bring nothing, those that turn above the floor come back as they went,
// less the absorption of their arc 2Rθ, R = c/(g cos ε).
TEST(NoiseInAGuide, OfRefractingWaterBySnellsLaw) {
  Environment ocean = guide(0.0);
  const double depths[] = {0.0, 100.0}, speeds[] = {1520.0, 1500.0};
  ocean.water = SoundSpeedProfile::table(depths, speeds, Interpolation::c_linear);
  const double depth = 60.0, c = 1508.0;
  const NoiseDirections down = surface_noise(ocean, depth, 1.0, 1000.0);
  for (const double deg : {-60.0, -35.0, -15.0, 15.0, 35.0, 60.0}) {
    const double cosine = std::cos(radians(deg));
    const double surface = std::acos(cosine * 1520.0 / c),
                 kept = floor_of(std::acos(cosine * 1500.0 / c));
    const double expected = std::sin(surface) / (1.0 - kept) * (deg < 0.0 ? kept : 1.0);
    EXPECT_NEAR(level_at(down, radians(deg)), 10.0 * std::log10(expected), 0.2) << deg;
  }
  EXPECT_LT(level_at(down, radians(4.0)), -100.0);  // cos 4° > 1508/1520
  const double warmer_below[] = {1500.0, 1520.0};
  ocean.water = SoundSpeedProfile::table(depths, warmer_below, Interpolation::c_linear);
  ocean.attenuation_db_per_km = 1.0;
  const NoiseDirections up = surface_noise(ocean, depth, 1.0, 1000.0);
  const double arc = 2.0 * radians(3.0) * 1512.0 / (0.2 * std::cos(radians(3.0)));
  EXPECT_NEAR(level_at(up, radians(3.0)) - level_at(up, radians(-3.0)), 1e-3 * arc, 0.05);
}

// The kind "surface": over a floor that sends nothing back the sheet's own closed form stays; over
// one that does an array of the scenario receives the guide.
TEST(NoiseInAGuide, IsWhatTheKindSurfaceIs) {
  Scenario s = support::two_platforms();
  s.noise = {.law = WhiteNoise{60.0}, .directions = {}};
  s.noise.coherence = NoiseCoherence::surface;
  s.environment.water_density = 1000.0;
  s.environment.bottom.material =
      FluidHalfSpace{.speed = 1500.0, .density = 1000.0, .attenuation_db_per_wavelength = 0.01};
  EXPECT_EQ(noise_field(s, 0).coherence, NoiseCoherence::surface);
  s.environment.bottom = guide(0.0).bottom;
  s.environment.bottom.depth = 400.0;
  const NoiseField field = noise_field(s, 0);
  ASSERT_EQ(field.coherence, NoiseCoherence::profile);
  for (const double deg : {10.0, 40.0, 70.0})
    EXPECT_NEAR(
        level_at(field.directions, radians(-deg)) - level_at(field.directions, radians(deg)),
        10.0 * std::log10(floor_of(radians(deg))), 0.2);
  s.noise.coherence = NoiseCoherence::isotropic;
  EXPECT_EQ(noise_field(s, 0).coherence, NoiseCoherence::isotropic);
}

}  // namespace
}  // namespace asdic::detail
