// What waves carry to ends that move: out of kernels that places share, against an integral anew at
// every moment, through a column that is cut where the ends are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "core/units.h"
#include "raytrace/waves/diffraction.h"
#include "raytrace/waves/water_window.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

/// A path at one moment of a pulse.
struct Moment {
  Complex p = 0.0;     ///< pressure
  double delay = 0.0;  ///< [s]
};

/// The plain form: all of the water anew. \param furthest  range of its window [m]
Complex integral(const Environment& water, double frequency, double source, double receiver,
                 double range, double furthest) {
  const WaveColumn column(water, frequency, source, std::span(&receiver, 1));
  const WaterWindow window = water_window(column, angle_of_spreading(water, frequency), furthest);
  std::array<double, DepthWaves::count> growth{};
  std::array<Complex, 1> g;
  const std::vector<Complex> factors = window.factors(range);
  Complex sum = 0.0;
  for (std::size_t j = 0; j < window.count; ++j) {
    column.kernels(Wavenumbers(1, [&](std::size_t) { return window.at(j); }), growth, g);
    sum += window.factor(window.at(j)) * factors[j] * g[0];
  }
  return sum;
}

Moment by_integral(const Environment& ocean, double frequency, double source, double receiver,
                   double range, double furthest) {
  const Environment water = without_bottom(ocean);
  const double about = range / ocean.water.at(receiver).c,
               step = std::min(1.0, 0.25 / (0.02 * furthest / 1500.0));
  const auto at = [&](double f) { return integral(water, f, source, receiver, range, furthest); };
  const Complex p = at(frequency),
                turned = std::conj(p) * at(frequency + step) *
                         std::polar(1.0, std::fmod(step * about, 1.0) * 2.0 * pi);
  return {p, about - std::arg(turned) / (2.0 * pi * step)};
}

Moment of(const Arrival& path, double frequency) {
  const double turns = std::fmod(frequency * path.delay, 1.0);
  return {path.amplitude * std::polar(1.0, -2.0 * pi * turns), path.delay};
}

Environment over(double depth, SoundSpeedProfile water) {
  return {
      .water = std::move(water),
      .bottom = {.depth = depth, .material = FluidHalfSpace{.speed = 1600.0, .density = 1500.0}}};
}

/// Munk's speeds at every 50 m. In between 1/c² is a line, as it is in the columns' layers: so that
/// these are exact wherever they are cut.
Environment munk() {
  const SoundSpeedProfile smooth = SoundSpeedProfile::munk();
  std::vector<double> depths, speeds;
  for (double z = 0.0; z <= 5000.0; z += 50.0)
    depths.push_back(z), speeds.push_back(smooth.at(z).c);
  return over(5000.0, SoundSpeedProfile::table(depths, speeds, Interpolation::n2_linear));
}

/// A layer over a thermocline.
Environment layered(double depth) {
  const std::vector<double> depths = {0.0, 0.3 * depth, 0.5 * depth, depth},
                            speeds = {1500.0, 1500.0 + 0.005 * depth, 1490.0, 1486.0};
  return over(depth, SoundSpeedProfile::table(depths, speeds, Interpolation::n2_linear));
}

struct Course {
  const char* name;
  Environment ocean;
  double frequency, source, receiver, range;  // [Hz], [m]
  double sinks = 0.0;                         // from moment to moment [m]
};

// Delays of all moments to 4 ns, a tenth of what turns the phase of 4 kHz by a thousandth, and
// pressures to 10⁻⁷. Sources near the surface, in the upper half of the duct and at its axis;
// behind limiting rays and caustics; in shallow and in deep water; through edges of layers.
TEST(DiffractionInMotion, IsTheIntegralAtEveryMoment) {
  const std::vector<Course> courses = {
      {"5 m, beyond the limiting ray", munk(), 1000.0, 5.0, 480.0, 2400.0},
      {"200 m", munk(), 1500.0, 200.0, 110.0, 4400.0},
      {"200 m, close behind the edge", munk(), 1000.0, 200.0, 110.0, 3900.0},
      {"500 m", munk(), 1000.0, 500.0, 110.0, 5800.0},
      {"500 m, sinking through an edge", munk(), 500.0, 500.0, 98.0, 5800.0, 1.1},
      {"1000 m, beyond a caustic", munk(), 100.0, 1000.0, 700.0, 40300.0, 0.7},
      {"in 100 m", layered(100.0), 3000.0, 5.0, 45.0, 2500.0},
      {"7 m in 200 m, sinking", layered(200.0), 2000.0, 7.0, 98.0, 4200.0, 1.1}};
  for (const Course& course : courses) {
    SCOPED_TRACE(course.name);
    const double f = course.frequency;
    PropagationMemory memory(std::size_t{1} << 28);
    const OceanMemory kept{memory};
    for (int moment = 0; moment < 5; ++moment) {
      const double range = course.range + 3.7 * moment,
                   receiver = course.receiver + course.sinks * moment;
      const auto path = diffracted_arrival(course.ocean, course.source, receiver, range, f, &kept);
      ASSERT_TRUE(path) << range;
      const Moment fast = of(*path, f),
                   plain = by_integral(course.ocean, f, course.source, receiver, range,
                                       furthest_in_step(range));
      EXPECT_LT(std::abs(fast.p - plain.p), 1e-7 * std::abs(plain.p)) << range;
      EXPECT_NEAR(fast.delay, plain.delay, 4e-9) << range;
      // with a window of its own, as wide as its range asks for
      const Moment own = by_integral(course.ocean, f, course.source, receiver, range, range);
      EXPECT_LT(std::abs(fast.p - own.p), 1e-3 / range) << range;
    }
  }
}

// Where the kernels of one furthest range end, those of the next have faded in: from metre to metre
// the delay bends as it does elsewhere.
TEST(DiffractionInMotion, HasNoJumpBetweenKernels) {
  const Environment ocean = munk();
  PropagationMemory memory(std::size_t{1} << 28);
  const OceanMemory kept{memory};
  const double end = furthest_in_step(5800.0 * 0.98);
  std::vector<double> delays;
  for (int i = -45; i <= 15; ++i)
    delays.push_back(diffracted_arrival(ocean, 500.0, 110.0, end + i, 500.0, &kept).value().delay);
  // Of a smooth curve nothing is left after four differences; the jump would be 20 ns.
  for (int order = 0; order < 4; ++order)
    for (std::size_t i = 0; i + 1 < delays.size(); ++i) delays[i] = delays[i + 1] - delays[i];
  for (std::size_t i = 0; i + 4 < delays.size(); ++i) EXPECT_LT(std::abs(delays[i]), 1e-9) << i;
}

// The same bits with whatever was known before, and nothing known.
TEST(DiffractionInMotion, DoesNotDependOnWhatIsKept) {
  const Environment ocean = layered(100.0);
  PropagationMemory memory(std::size_t{1} << 28);
  const OceanMemory kept{memory};
  for (const double range : {2600.0, 2500.0, 2504.0, 2500.0}) {
    const auto known = diffracted_arrival(ocean, 5.0, 45.0, range, 1500.0, &kept),
               anew = diffracted_arrival(ocean, 5.0, 45.0, range, 1500.0);
    ASSERT_TRUE(known && anew);
    EXPECT_EQ(known->amplitude, anew->amplitude);
    EXPECT_EQ(known->delay, anew->delay);
  }
}

}  // namespace
}  // namespace asdic::detail
