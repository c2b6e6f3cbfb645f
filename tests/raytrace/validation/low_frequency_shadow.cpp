// Beside and beyond the limiting ray at frequencies whose Airy's length, 20 to 80 m, is longer than
// the source is deep: direct sound and its image all but cancel. Against the depth equation by
// finite differences, which share nothing with ours.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/units.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/waves/cycles.h"
#include "raytrace/waves/diffraction.h"
#include "support/sum_of.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double at_surface = 1500.0, gradient = -0.03;  // [m/s], [1/s]

struct Places {
  double frequency, source, receiver;  // [Hz], depths [m]
};

double limiting_range(const Places& at) {
  return std::sqrt(2.0 * at_surface / -gradient) * (std::sqrt(at.source) + std::sqrt(at.receiver));
}

/// g″ + (k² − ξ²)g = −2δ(z − z_s) by three points, g = 0 at the surface, an absorber below 900 m;
/// summed over ξ above the real axis with the outgoing half of J₀. \return levels [dB re 1 m]
std::vector<double> by_finite_differences(const Places& at, const std::vector<double>& ranges) {
  constexpr double step = 0.5, floor = 1800.0, absorber = 900.0, period = 40000.0;
  const double omega = 2.0 * pi * at.frequency, k = omega / at_surface;
  const auto count = std::size_t(floor / step) - 1;
  const auto source = std::size_t(std::lround(at.source / step)) - 1,
             receiver = std::size_t(std::lround(at.receiver / step)) - 1;
  std::vector<Complex> k2(count), over(count), g(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = double(i + 1) * step, x = std::max(0.0, (z - absorber) / (floor - absorber));
    const double kz = omega / (at_surface + gradient * z);
    k2[i] = kz * kz * Complex(1.0, -0.3 * x * x);
  }
  const double spacing = 2.0 * pi / period, steep = k * std::cos(radians(88.0)),
               flat = k * std::cos(radians(50.0));
  std::vector<Complex> sums(ranges.size(), 0.0);
  for (double s = steep; s < 1.4 * k; s += spacing) {
    const Complex xi(s, spacing);
    // Gauss's elimination of the three diagonals 1, d, 1 (times step²)
    const auto diagonal = [&](std::size_t i) { return (k2[i] - xi * xi) * step * step - 2.0; };
    g.assign(count, 0.0);
    g[source] = -2.0 * step;
    over[0] = 1.0 / diagonal(0);
    g[0] *= over[0];
    for (std::size_t i = 1; i < count; ++i) {
      over[i] = 1.0 / (diagonal(i) - over[i - 1]);
      g[i] = (g[i] - g[i - 1]) * over[i];
    }
    for (std::size_t i = count - 1; i-- > receiver;) g[i] -= over[i] * g[i + 1];
    const double rise = 0.5 * std::erfc(4.0 - 8.0 * (s - steep) / (flat - steep));
    const Complex f = rise * g[receiver] * std::sqrt(xi) * spacing;
    for (std::size_t i = 0; i < ranges.size(); ++i)
      sums[i] +=
          f * std::sqrt(0.5 / (pi * ranges[i])) * std::exp(Complex(0.0, -1.0) * xi * ranges[i]);
  }
  std::vector<double> levels;
  for (const Complex& sum : sums) levels.push_back(db_from_amplitude(std::abs(sum)));
  return levels;
}

double by_paths(const Places& at, double range) {
  const std::vector<double> depths{0.0, 1000.0}, speeds{at_surface, at_surface + 1000.0 * gradient};
  Environment ocean{.water = SoundSpeedProfile::table(depths, speeds, Interpolation::c_linear)};
  ocean.bottom = {.depth = 1000.0, .material = FluidHalfSpace{.speed = 1470.0, .density = 1027.0}};
  const PathLimits limits{.max_surface_bounces = 1, .max_bottom_bounces = 0};
  const EigenraySolver solver(ocean);
  Arrivals paths = solver.find(at.source, at.receiver, range, at.frequency, limits);
  put_waves(solver, at.source, at.receiver, range, at.frequency, limits, paths);
  if (const auto more =
          diffracted_arrival(ocean, at.source, at.receiver, range, at.frequency, paths))
    paths.push_back(*more);
  return db_from_amplitude(std::abs(support::sum_of(paths, at.frequency)));
}

TEST(LowFrequencyShadow, IsTheWavesOnEitherSideOfItsEdge) {
  for (const Places& at : {Places{50.0, 5.0, 50.0},
                           {100.0, 5.0, 50.0},
                           {100.0, 30.0, 50.0},
                           {200.0, 30.0, 50.0},
                           {200.0, 50.0, 30.0}}) {
    const double edge = limiting_range(at);
    std::vector<double> ranges;
    for (const double part : {0.5, 0.8, 0.95, 0.99, 1.01, 1.05, 1.2}) ranges.push_back(part * edge);
    const std::vector<double> truth = by_finite_differences(at, ranges);
    for (std::size_t i = 0; i < ranges.size(); ++i)
      EXPECT_NEAR(by_paths(at, ranges[i]), truth[i], 0.2)
          << at.frequency << " Hz, " << at.source << " to " << at.receiver << " m, " << ranges[i];
  }
}

/// Waves in water that is fastest at 1000 m, below which it goes on level. \param bottom  depth [m]
Complex above_a_bottom(double bottom, const BoundaryMaterial& material, double receiver) {
  const std::vector<double> depths{0.0, 1000.0, 1500.0}, speeds{1500.0, 1530.0, 1530.0};
  Environment ocean{.water = SoundSpeedProfile::table(depths, speeds, Interpolation::c_linear)};
  ocean.bottom = {.depth = bottom, .material = material};
  const auto wave = diffracted_arrival(ocean, 50.0, receiver, 10500.0, 50.0);
  return wave ? support::sum_of({*wave}, 50.0) : Complex(0.0);
}

// Sound that the limiting ray carries to a receiver a tenth of a wavelength above the bottom: the
// field there and that of the mirrored place, where the water goes on below. Vertical wavenumbers
// are some 0.01/m: (2·3 m·0.01/m)² = 0.004 is left out by taking the field for an exponential, and
// 0.002 by the share of the bottom, which is 0.998.
TEST(LowFrequencyShadow, IsReflectedByTheBottomCloseBelow) {
  constexpr double bottom = 1000.0;
  for (const double height : {0.3, 1.0, 3.0}) {
    const Complex above = above_a_bottom(1500.0, Vacuum{}, bottom - height),
                  below = above_a_bottom(1500.0, Vacuum{}, bottom + height);
    ASSERT_GT(std::abs(above), 0.0);
    EXPECT_LT(std::abs(above_a_bottom(bottom, Vacuum{}, bottom - height) - (above - below)),
              0.01 * std::abs(above))
        << height;
    EXPECT_LT(std::abs(above_a_bottom(bottom, Rigid{}, bottom - height) - (above + below)),
              0.01 * std::abs(above))
        << height;
  }
}

}  // namespace
}  // namespace asdic::detail
