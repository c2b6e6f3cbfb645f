#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "core/units.h"
#include "raytrace/paths/boundary_paths.h"
#include "raytrace/paths/eigenrays.h"
#include "support/csv.h"
#include "support/integrator.h"

// Every eigenray of the reference files is found and none is invented: delay within 1 µs, angles
// within 0.001°, amplitude within 0.02 dB. The references are closed forms or integrations at 1e-12
// (tests/data/README.md), so the tolerances are the solver's.
namespace asdic::detail {
namespace {

struct Expected {
  double launch_deg, arrival_deg, delay, amplitude;
  int surface = -1, bottom = -1, caustics = -1;
};

double angle_error(const Arrival& a, const Expected& e) {
  return std::max(std::abs(degrees(a.launch_elevation) - e.launch_deg),
                  std::abs(degrees(a.arrival_elevation) - e.arrival_deg));
}

/// The arrival whose launch angle is nearest.
const Arrival& nearest(const Arrivals& found, const Expected& wanted) {
  return *std::min_element(found.begin(), found.end(), [&](const Arrival& a, const Arrival& b) {
    return angle_error(a, wanted) < angle_error(b, wanted);
  });
}

void expect_match(const Arrivals& found, const Expected& wanted) {
  ASSERT_FALSE(found.empty());
  const Arrival& a = nearest(found, wanted);
  EXPECT_LT(angle_error(a, wanted), 1e-3);
  EXPECT_NEAR(a.delay, wanted.delay, 1e-6);
  EXPECT_NEAR(db_from_amplitude(std::abs(a.amplitude) / wanted.amplitude), 0.0, 0.02);
  if (wanted.surface >= 0) {
    EXPECT_EQ(a.surface_bounces, wanted.surface);
  }
  if (wanted.bottom >= 0) {
    EXPECT_EQ(a.bottom_bounces, wanted.bottom);
  }
  if (wanted.caustics >= 0) {
    EXPECT_EQ(a.caustics, wanted.caustics);
  }
}

TEST(Eigenrays, IsovelocityImages) {
  const support::Csv csv("physics-reference/rays_isovelocity_images.csv");
  std::map<std::tuple<double, double, double, double, double>, std::vector<Expected>> cases;
  for (std::size_t i = 0; i < csv.rows(); ++i)
    cases[{csv["range_m"][i], csv["zs_m"][i], csv["zr_m"][i], csv["depth_m"][i], csv["c"][i]}]
        .push_back({csv["launch_elev_deg_up"][i], csv["arrival_elev_deg_up"][i], csv["delay_s"][i],
                    csv["signed_amplitude"][i], static_cast<int>(csv["n_surface"][i]),
                    static_cast<int>(csv["n_bottom"][i])});
  for (const auto& [where, wanted] : cases) {
    const auto [range, zs, zr, depth, c] = where;
    Environment ocean{.water = SoundSpeedProfile::isovelocity(c)};
    ocean.bottom.depth = depth;
    const Arrivals found = EigenraySolver(ocean).find(
        zs, zr, range, 1000.0, {.max_surface_bounces = 20, .max_bottom_bounces = 20});
    ASSERT_GE(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size();
         ++i) {  // the file holds the first 14; images come in order of delay
      const Arrival& a = found[i];
      EXPECT_LT(angle_error(a, wanted[i]), 1e-3);
      EXPECT_NEAR(a.delay, wanted[i].delay, 1e-6);
      EXPECT_NEAR(
          a.amplitude.real(), wanted[i].amplitude,
          1e-8 *
              std::abs(wanted[i].amplitude));  // the sign too; a root is right to 0.01 mm in 3 km
      EXPECT_NEAR(a.amplitude.imag(), 0.0, 1e-12);
      EXPECT_EQ(a.surface_bounces, wanted[i].surface);
      EXPECT_EQ(a.bottom_bounces, wanted[i].bottom);
    }
  }
}

// Source and receiver at one depth without gradient: the direct ray runs along it. On the axis of
// Munk's profile its beam focuses with k = √(c″/c): q = sin(kr)/k.
TEST(Eigenrays, AlongALevel) {
  const double range = 30e3;
  Environment uniform{.water = SoundSpeedProfile::isovelocity(1500.0)};
  const Arrivals direct = EigenraySolver(uniform).find(
      4500.0, 4500.0, range, 1000.0, {.max_surface_bounces = 0, .max_bottom_bounces = 0});
  ASSERT_EQ(direct.size(), 1U);
  EXPECT_NEAR(direct[0].delay, 20.0, 1e-12);
  EXPECT_NEAR(direct[0].amplitude.real(), 1.0 / range, 1e-15);

  const Environment munk{.water = SoundSpeedProfile::munk()};
  const Arrivals ducted = EigenraySolver(munk).find(
      1300.0, 1300.0, range, 1000.0, {.max_surface_bounces = 0, .max_bottom_bounces = 0});
  const auto axial = std::count_if(ducted.begin(), ducted.end(), [](const Arrival& a) {
    return std::abs(a.launch_elevation) < 1e-6;
  });
  EXPECT_EQ(axial, 1);
  const auto axis = std::find_if(ducted.begin(), ducted.end(), [](const Arrival& a) {
    return std::abs(a.launch_elevation) < 1e-6;
  });
  ASSERT_NE(axis, ducted.end());
  const double k = std::sqrt(munk.water.at(1300.0).d2c_dz2 / 1500.0);
  EXPECT_NEAR(axis->delay, range / 1500.0, 1e-9);
  EXPECT_NEAR(std::abs(axis->q), std::abs(std::sin(k * range) / k),
              1e-3 * std::abs(std::sin(k * range) / k));
  EXPECT_EQ(axis->caustics, static_cast<int>(k * range / pi));
}

// Straight above: one vertical path, up to the receiver, with spherical spreading and R = −1, +1
// where it bounces.
TEST(Eigenrays, StraightUp) {
  Environment ocean{.water = SoundSpeedProfile::isovelocity(1500.0)};  // 5000 m, rigid
  for (const double range : {0.0, 1e-6, 0.05}) {
    const Arrivals found = EigenraySolver(ocean).find(
        4500.0, 3500.0, range, 1000.0, {.max_surface_bounces = 1, .max_bottom_bounces = 1});
    ASSERT_EQ(found.size(), 5U);  // direct; bottom; surface; surface and bottom in either order
    EXPECT_NEAR(degrees(found[0].launch_elevation), 90.0, 0.01 + degrees(range / 1000.0));
    EXPECT_NEAR(found[0].delay, 1000.0 / 1500.0, 1e-8);
    EXPECT_NEAR(found[0].amplitude.real(), 1.0 / 1000.0, 1e-8);
    EXPECT_NEAR(degrees(found[1].launch_elevation), -90.0, 0.01);
    EXPECT_NEAR(found[1].amplitude.real(), 1.0 / 2000.0, 1e-8);
    EXPECT_NEAR(found[2].amplitude.real(), -1.0 / 8000.0, 1e-8);
    if (range == 0.0) {
      EXPECT_EQ(found[0].launch_elevation, 0.5 * pi);
    }
  }
}

// The rows' paths run in an unbounded medium: boundaries are put far away and bounces forbidden.
TEST(Eigenrays, ConstantGradientArcs) {
  const support::Csv csv("physics-reference/rays_const_gradient.csv");
  for (std::size_t i = 0; i < csv.rows(); ++i) {
    const double c0 = csv["c0"][i], g = csv["g"][i];
    const std::vector<double> depth = {0.0, 5000.0}, speed = {c0, c0 + g * 5000.0};
    Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear)};
    ocean.surface.depth = -20e3;
    ocean.bottom.depth = g > 0 ? 60e3 : 25e3;
    const Arrivals found =
        EigenraySolver(ocean).find(csv["zs_m"][i], csv["zr_m"][i], csv["range_m"][i], 1000.0,
                                   {.max_surface_bounces = 0, .max_bottom_bounces = 0});
    ASSERT_EQ(found.size(), 1U) << "row " << i;  // two points lie on one arc without reflection
    expect_match(found, {csv["launch_elev_deg_up"][i], csv["arrival_elev_deg_up"][i],
                         csv["delay_s"][i], csv["amplitude"][i], 0, 0});
    EXPECT_NEAR(found[0].path_length, csv["path_m"][i], 1e-6 * csv["path_m"][i]);
    EXPECT_NEAR(std::abs(found[0].q), csv["q_m"][i], 1e-6 * csv["q_m"][i]);
  }
}

TEST(Eigenrays, N2LinearParabolas) {
  const support::Csv csv("physics-reference/rays_n2_linear.csv");
  for (std::size_t i = 0; i < csv.rows();
       i += 2) {  // rows come in pairs: the two parabolas through two points
    const double c0 = csv["c0"][i], a = csv["a_per_m"][i];  // 1/c² = (1 + a z)/c0²
    const auto speed_at = [&](double z) { return c0 / std::sqrt(1.0 + a * z); };
    const std::vector<double> depth = {-7499.9, 5000.0},
                              speed = {speed_at(-7499.9), speed_at(5000.0)};
    Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::n2_linear)};
    ocean.surface.depth = -7499.9;  // n² vanishes at −7500 m
    ocean.bottom.depth = 10e3;
    const Arrivals found =
        EigenraySolver(ocean).find(csv["zs_m"][i], csv["zr_m"][i], csv["range_m"][i], 1000.0,
                                   {.max_surface_bounces = 0, .max_bottom_bounces = 0});
    EXPECT_EQ(found.size(), 2U) << "row " << i;
    for (std::size_t row : {i, i + 1})
      expect_match(found, {csv["launch_elev_deg_up"][row], csv["arrival_elev_deg_up"][row],
                           csv["delay_s"][row], csv["amplitude"][row], 0, 0,
                           static_cast<int>(csv["kmah"][row])});
  }
}

// Munk's profile by its analytic derivatives. Every row is found. What is found beyond the file,
// within its own limits (3 bounces, ±80°), must be a ray in the eyes of the independent integrator:
// it passes within a millimetre of the receiver at the stated delay, with the stated bounces and
// spreading. There is one such, from 4500 m to 27 km: it grazes the surface at 4.65°, a hundredth
// of a degree above the ray that only touches it, and the file lacks it. (One row of the file has 4
// bounces.)
TEST(Eigenrays, Munk) {
  const support::Csv csv("physics-reference/rays_munk_eigenrays.csv");
  std::map<std::tuple<double, double, double, double>, std::vector<std::size_t>> cases;
  for (std::size_t i = 0; i < csv.rows(); ++i)
    cases[{csv["water_depth_m"][i], csv["zs_m"][i], csv["zr_m"][i], csv["range_m"][i]}].push_back(
        i);
  std::size_t rows = 0, unlisted = 0;
  for (const auto& [where, wanted] : cases) {
    const auto [depth, zs, zr, range] = where;
    SCOPED_TRACE(testing::Message() << "depth " << depth << " source " << zs << " range " << range);
    Environment ocean{.water = SoundSpeedProfile::munk()};
    ocean.bottom.depth = depth;
    const Arrivals found = EigenraySolver(ocean).find(
        zs, zr, range, 1000.0,
        {.max_surface_bounces = 3, .max_bottom_bounces = 3, .max_launch_angle = radians(80.0)});
    std::vector<bool> listed(found.size(), false);
    for (const std::size_t i : wanted) {
      const Expected row{csv["launch_elev_deg_up"][i],
                         csv["arrival_elev_deg_up"][i],
                         csv["delay_s"][i],
                         csv["amplitude_re1m"][i],
                         static_cast<int>(csv["n_surface"][i]),
                         static_cast<int>(csv["n_bottom"][i]),
                         static_cast<int>(csv["kmah"][i])};
      expect_match(found, row);
      const Arrival& a = nearest(found, row);
      EXPECT_NEAR(a.path_length, csv["path_m"][i], 1e-3);
      listed[static_cast<std::size_t>(&a - found.data())] = true;
      ++rows;
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Arrival& a = found[i];
      if (listed[i] || a.surface_bounces + a.bottom_bounces > 3) continue;
      ++unlisted;
      support::RayIntegrator integrator(ocean.water, 0.0, depth);
      const support::RayPoint ray = integrator.trace(zs, a.launch_elevation, range);
      EXPECT_NEAR(ray.depth, zr, 1e-3);
      EXPECT_NEAR(ray.time, a.delay, 1e-6);
      EXPECT_NEAR(std::abs(ray.q / a.q), 1.0, 1e-3);
      EXPECT_EQ(ray.surface_bounces, a.surface_bounces);
      EXPECT_EQ(ray.bottom_bounces, a.bottom_bounces);
      EXPECT_NEAR(degrees(a.launch_elevation), 4.653, 1e-3);
    }
  }
  EXPECT_EQ(rows, csv.rows());
  EXPECT_EQ(unlisted, 1U);
}

// The first cells of the surface, all but straight above: image sources at depths z_s and 2H − z_s,
// 1/distance each, over a rigid bottom. The grid's ranges are right to a hundredth of the spacing,
// 0.2 m: 1e-4 of the shorter distance, 200 m, and with the slopes of its cubics, some eight times
// that over a spacing, 1e-3 of the amplitude.
TEST(BoundaryPaths, StraightAboveAreThoseOfImageSources) {
  Environment ocean;
  ocean.bottom = {.depth = 900.0, .material = Rigid{}};
  constexpr double source = 200.0, spacing = 20.0;
  for (const bool marched : {false, true}) {
    if (marched)
      ocean.bottom.shape = BoundaryShape(std::vector{-1e4, 1e4}, std::vector{900.0, 900.0},
                                         ShapeInterpolation::piecewise_linear);
    const BoundaryPaths ground = boundary_paths(
        EigenraySolver(ocean), source, BoundaryKind::surface, spacing, 400.0, 1000.0,
        {.max_surface_bounces = 0, .max_bottom_bounces = 1, .max_launch_angle = 0.5 * pi});
    for (std::size_t cell = 0; cell < 4; ++cell) {
      SCOPED_TRACE(testing::Message() << "cell " << cell << (marched ? " marched" : " layered"));
      const double r = (static_cast<double>(cell) + 0.5) * spacing;
      for (const double depth : {source, 2.0 * 900.0 - source}) {
        const double distance = std::hypot(r, depth);
        double nearest = infinity;
        for (const BoundaryPath& path : ground.paths(cell))
          if (std::abs(path.delay - distance / 1500.0) < 1e-3)
            nearest = std::min(nearest, std::abs(std::abs(path.amplitude) * distance - 1.0));
        EXPECT_LT(nearest, 1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace asdic::detail
