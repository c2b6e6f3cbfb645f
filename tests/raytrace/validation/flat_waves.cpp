// Waves about the axis of a duct, too flat to be resolved into cycles, against normal modes.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "raytrace/places/propagation_paths.h"
#include "support/depth_modes.h"

namespace asdic::detail {
namespace {

/// Energy Σ|A|² of a leg's paths, of its loudest path, and of all paths added in phase.
struct Energy {
  double all = 0.0, loudest = 0.0;
  std::complex<double> sum = 0.0;
};

Energy energy_of(const Environment& ocean, double frequency, double source, double receiver,
                 double range, int bounces) {
  const PropagationPaths paths(ocean, {});
  const PathLimits limits{
      .max_surface_bounces = bounces, .max_bottom_bounces = bounces, .diffraction = true};
  Energy energy;
  for (const Arrival& path :
       paths.find({0.0, 0.0, source}, {range, 0.0, receiver}, frequency, limits)) {
    energy.all += std::norm(path.amplitude);
    energy.loudest = std::max(energy.loudest, std::norm(path.amplitude));
    energy.sum +=
        path.amplitude * std::polar(1.0, -2.0 * pi * std::fmod(frequency * path.delay, 1.0));
  }
  return energy;
}

/// The Mediterranean in summer.
Environment mediterranean() {
  const std::vector<double> depth = {0, 15, 30, 50, 80, 120, 200, 400, 800, 1500, 2600},
                            speed = {1536, 1535, 1525,   1515,   1510.5, 1509,
                                     1510, 1513, 1519.2, 1530.5, 1548.5};
  Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::pchip)};
  ocean.bottom = {.depth = 2600.0,
                  .material = FluidHalfSpace{
                      .speed = 1550.0, .density = 1500.0, .attenuation_db_per_wavelength = 0.1}};
  return ocean;
}

double db(double power) { return 10.0 * std::log10(power); }

// The Mediterranean in summer, at 40 km, with a receiver near the minimum of the speed, a node of
// the profile. The paths' energy is that of the modes within 3 dB, which allows for interference
// within a cycle. It was 19 to 35 dB higher.
TEST(FlatWaves, AboutTheAxisOfAProfile) {
  const Environment ocean = mediterranean();
  const double f = 200.0, omega = 2.0 * pi * f, range = 40311.0;
  const auto modes = support::depth_modes(
      f, 3000.0, false, 3000, [&](double z) { return z <= 2600.0 ? ocean.water.at(z).c : 1550.0; },
      [](double z) { return z <= 2600.0 ? 1.027 : 1.5; }, omega / 1548.0, omega / 1500.0);
  for (const double source : {150.0, 300.0})
    for (const double receiver : {100.0, 110.0, 119.0, 120.0, 120.01, 122.0, 130.0, 140.0, 160.0}) {
      const Energy paths = energy_of(ocean, f, source, receiver, range, 3);
      const double truth = modes.energy(source, receiver, range, 1.027);
      EXPECT_NEAR(db(paths.all), db(truth), 3.0) << source << " m, " << receiver << " m";
      EXPECT_LT(db(paths.loudest), db(truth)) << source << " m, " << receiver << " m";
    }
}

// Paths followed two wavelengths further have waves' amplitudes, although some of their rays are
// no more found beside where they were. All together are the paths found there. Such legs had rays'
// amplitudes, and their sum differed by half.
TEST(FlatWaves, PathsThatAreFollowedHaveThem) {
  const Environment ocean = mediterranean();
  const PropagationPaths paths(ocean, {});
  const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 3, .diffraction = true};
  const double f = 200.0;
  const auto pressure = [&](const Arrivals& leg) {
    std::complex<double> sum = 0.0;
    for (const Arrival& path : leg)
      sum += path.amplitude * std::polar(1.0, -2.0 * pi * std::fmod(f * path.delay, 1.0));
    return sum;
  };
  const Vec3 source(0.0, 0.0, 300.0);
  const Arrivals known = paths.find(source, {80000.0, 0.0, 150.0}, f, limits);
  for (double range = 80004.0; range < 80030.0; range += 4.0) {
    const Vec3 place(range, 0.0, 150.0);
    const Arrivals followed = paths.follow(known, source, place, f, limits),
                   found = paths.find(source, place, f, limits);
    double energy = 0.0;
    for (const Arrival& path : found) energy += std::norm(path.amplitude);
    EXPECT_LT(std::abs(pressure(followed) - pressure(found)), 0.1 * std::sqrt(energy)) << range;
  }
}

// A smooth channel over a rigid floor. With few bounces the energy is at most that of the modes
// that stay in the water, with many bounces that of all modes. It was 64 and 157 dB higher.
TEST(FlatWaves, AboutTheAxisOfASpline) {
  const std::vector<double> depth = {0.0, 148.116, 296.233, 402.226, 508.22},
                            speed = {1497.2208, 1492.8883, 1490.0, 1492.1663, 1495.7767};
  Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::spline)};
  ocean.bottom = {.depth = 508.22, .material = Rigid{}};
  const double f = 173.4, omega = 2.0 * pi * f, range = 30338.57, source = 148.116;
  const auto modes_from = [&](double least) {
    return support::depth_modes(
        f, 508.22, true, 2000, [&](double z) { return ocean.water.at(z).c; },
        [](double) { return 1.0; }, least, omega / 1489.0);
  };
  const auto trapped = modes_from(omega / 1495.7767), all = modes_from(0.1 * omega / 1500.0);
  for (const double receiver : {150.0, 200.0, 216.594, 218.0, 250.0, 296.233}) {
    // The reverse direction has other rays near a caustic but the same waves; each ray may be 0.1 %
    // off.
    const auto there = energy_of(ocean, f, source, receiver, range, 2),
               home = energy_of(ocean, f, receiver, source, range, 2);
    EXPECT_LT(std::abs(there.sum - home.sum), 0.01 * std::sqrt(there.all)) << receiver;
    EXPECT_LT(db(energy_of(ocean, f, source, receiver, range, 2).all),
              db(trapped.energy(source, receiver, range, 1.0)) + 3.0)
        << receiver;
    EXPECT_NEAR(db(energy_of(ocean, f, source, receiver, range, 60).all),
                db(all.energy(source, receiver, range, 1.0)), 3.0)
        << receiver;
  }
}

}  // namespace
}  // namespace asdic::detail
