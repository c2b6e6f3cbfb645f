// Waves along the boundaries, which are no rays, against the wave equation: far away they are all
// there is beside an elastic wall, since direct and reflected sound cancel like 1/r².
#include "raytrace/waves/interface_wave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "raytrace/propagation.h"

namespace asdic::detail {
namespace {

const ReflectionTable nothing_back{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};

/// Root of the mean energy over a wavelength about a range.
double waves_about(const Environment& ocean, double depth, double range, double frequency) {
  PropagationCase c;
  c.environment = ocean;
  c.frequency = frequency;
  c.source_depths = {depth};
  c.solver = FieldSolver::waves;
  c.receivers.depths = {depth};
  constexpr int places = 16;
  for (int i = 0; i < places; ++i)
    c.receivers.ranges.push_back(range + 1500.0 / frequency * i / places);
  double sum = 0.0;
  for (const std::complex<float>& p : run(c).field) sum += double(std::norm(p)) / places;
  return std::sqrt(sum);
}

TEST(InterfaceWave, IsTheFieldFarAlongAnElasticFloor) {
  Environment ocean;
  ocean.surface = {.depth = 0.0, .material = nothing_back};
  for (const double shear : {1100.0, 1800.0}) {
    ocean.bottom = {.depth = 500.0,
                    .material = ElasticHalfSpace{.speed = 3500.0,
                                                 .shear_speed = shear,
                                                 .density = 2000.0,
                                                 .attenuation_db_per_wavelength = 0.0,
                                                 .shear_attenuation_db_per_wavelength = 0.01}};
    for (const double away : {2.0, 6.0}) {
      const double depth = 500.0 - away, range = 4000.0;
      const double all = waves_about(ocean, depth, range, 50.0),
                   wave = interface_wave_pressure(ocean, depth, depth, range, 50.0);
      EXPECT_NEAR(wave / all, 1.0, 0.1) << shear << ' ' << away;
    }
  }
}

TEST(InterfaceWave, IsTheFieldFarAlongAPlateOfIce) {
  Environment ocean;
  ocean.surface = {.depth = 3.0,
                   .material = ElasticHalfSpace{.speed = 3500.0,
                                                .shear_speed = 1800.0,
                                                .density = 900.0,
                                                .attenuation_db_per_wavelength = 0.0,
                                                .shear_attenuation_db_per_wavelength = 0.01}};
  ocean.bottom = {.depth = 500.0, .material = nothing_back};
  const double all = waves_about(ocean, 5.0, 4000.0, 100.0),
               wave = interface_wave_pressure(ocean, 5.0, 5.0, 4000.0, 100.0);
  EXPECT_NEAR(wave / all, 1.0, 0.1);
}

// Nothing runs along what does not yield, nor along a fluid.
TEST(InterfaceWave, IsNoneBesideWallsWithoutShear) {
  Environment ocean;
  for (const BoundaryMaterial& material :
       {BoundaryMaterial(Vacuum{}), BoundaryMaterial(Rigid{}),
        BoundaryMaterial(FluidHalfSpace{.speed = 1600.0, .density = 1800.0})}) {
    ocean.bottom = {.depth = 100.0, .material = material};
    EXPECT_EQ(interface_wave_pressure(ocean, 95.0, 95.0, 1000.0, 100.0), 0.0);
  }
}

}  // namespace
}  // namespace asdic::detail
