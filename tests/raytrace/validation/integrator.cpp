// The tests' own ray integrator against exact and independent references: it must be right before
// it judges the solvers.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/sound_speed.h"
#include "support/csv.h"
#include "support/integrator.h"

namespace asdic::detail {
namespace {

using support::Csv;
using support::RayIntegrator;
using support::RayPoint;

// c linear in depth: circular arcs, known to 12 digits.
TEST(RayIntegrator, CircularArcs) {
  const Csv csv("physics-reference/rays_const_gradient.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double c0 = csv["c0"][row], g = csv["g"][row];
    const std::vector<double> z = {0.0, 6000.0}, c = {c0, c0 + 6000.0 * g};
    const auto water = SoundSpeedProfile::table(z, c, Interpolation::c_linear);
    const RayPoint ray =
        RayIntegrator(water, -1e5, 1e5)
            .trace(csv["zs_m"][row], radians(csv["launch_elev_deg_up"][row]), csv["range_m"][row]);
    // The launch angle is printed to 1e-12°·|q| = 2e-10 m of depth, the delay to 1e-11 s.
    EXPECT_NEAR(ray.depth, csv["zr_m"][row], 1e-8) << row;
    EXPECT_NEAR(ray.time, csv["delay_s"][row], 1e-10) << row;
    EXPECT_NEAR(ray.q, csv["q_m"][row], 1e-7) << row;
    EXPECT_NEAR(ray.path, csv["path_m"][row], 2e-8) << row;
    EXPECT_NEAR(degrees(ray.elevation()), csv["arrival_elev_deg_up"][row], 1e-10) << row;
  }
}

// Munk over a flat bottom, up to three bounces and several caustics: DOP853 at rtol 1e-12. Printed:
// angle 1e-9°, so 2e-11·|q| ≤ 2e-6 m of depth; delay 1e-10 s, good to 1e-9; q 1e-6 m.
TEST(RayIntegrator, MunkEigenrays) {
  const auto water = SoundSpeedProfile::munk();
  const Csv csv("physics-reference/rays_munk_eigenrays.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    RayIntegrator integrator(water, 0.0, csv["water_depth_m"][row]);
    const RayPoint ray = integrator.trace(csv["zs_m"][row], radians(csv["launch_elev_deg_up"][row]),
                                          csv["range_m"][row]);
    const double q = std::abs(csv["q_m_per_rad"][row]);
    EXPECT_NEAR(ray.depth, csv["zr_m"][row], 1e-6 + 1e-10 * q) << row;
    EXPECT_NEAR(ray.time, csv["delay_s"][row], 1e-9) << row;
    EXPECT_NEAR(std::abs(ray.q), q, 1e-3 + 1e-7 * q) << row;
    EXPECT_NEAR(ray.path, csv["path_m"][row], 2e-5) << row;
    EXPECT_EQ(ray.surface_bounces, csv["n_surface"][row]) << row;
    EXPECT_EQ(ray.bottom_bounces, csv["n_bottom"][row]) << row;
    EXPECT_EQ(ray.caustics, csv["kmah"][row]) << row;
  }
}

// q is what two neighbouring rays say it is, across kinks and bounces of every kind: ∂n/∂θ₀, with
// ∂z/∂θ₀ at a fixed range = ∓q/cos θ. A central difference over ±h errs by h²·z‴/6; with h = 1e-6
// rad and derivatives of z of order range·10^k this leaves some 1e-6 of q, and rounding 1e-9/h.
TEST(RayIntegrator, SpreadingIsTheDerivativeOfDepth) {
  const std::vector<double> z = {0.0, 100.0, 300.0, 1000.0, 3000.0};
  const std::vector<double> c = {1515.0, 1518.0, 1495.0, 1485.0, 1520.0};
  for (const Interpolation rule : {Interpolation::c_linear, Interpolation::n2_linear,
                                   Interpolation::spline, Interpolation::pchip}) {
    const auto water = SoundSpeedProfile::table(z, c, rule);
    RayIntegrator integrator(water, 0.0, 2500.0);
    for (const double elevation : {-0.3, -0.05, 0.08, 0.25}) {
      const double h = 1e-6;
      const auto at = [&](double e) { return integrator.trace(500.0, e, 15'000.0); };
      const RayPoint ray = at(elevation), up = at(elevation + h), down = at(elevation - h);
      ASSERT_EQ(up.surface_bounces + up.bottom_bounces, down.surface_bounces + down.bottom_bounces);
      const double derivative = (up.depth - down.depth) / (2.0 * h);
      const double expected = std::abs(ray.q) / std::cos(ray.elevation());
      EXPECT_NEAR(std::abs(derivative), expected, 1e-2 + 1e-5 * expected)
          << name(rule) << ' ' << elevation;
      EXPECT_NEAR(ray.xi, std::cos(ray.elevation()) / water.at(ray.depth).c, 1e-15);
    }
  }
}

}  // namespace
}  // namespace asdic::detail
