#include "raytrace/tracing/ray_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "raytrace/tracing/marching_eigenrays.h"
#include "raytrace/tracing/root_finder.h"
#include "support/oceans.h"
#include "support/test_id.h"

namespace asdic::detail {
namespace {

std::vector<support::CurvedOcean> oceans() {
  std::vector<support::CurvedOcean> all;
  for (const support::CurvedOcean& ocean : support::curved_oceans())
    if (ocean.name != "flat" && ocean.name != "ridge under spline") all.push_back(ocean);
  support::CurvedOcean turning = all.front();
  turning.name = "curvilinear swell";
  turning.environment.bottom.shape.reset();
  turning.environment.surface.shape = support::swell(ShapeInterpolation::curvilinear, 101);
  turning.range = 3000.0;
  all.push_back(turning);
  return all;
}

class RayFamilies : public testing::TestWithParam<support::CurvedOcean> {};
INSTANTIATE_TEST_SUITE_P(Marching, RayFamilies, testing::ValuesIn(oceans()),
                         [](const auto& test) { return support::test_id(test.param.name); });

// A grid of receivers is served by families; a receiver alone is one too few for them, so that each
// of its roots is a traced ray, to 1e-6 m: the plain way. The polynomials are right to a micrometre
// in depth and delay, so the launch angle is right to that over ∂z/∂α = q/(c·ξ), and the quartics
// to a part of the 2e-5 that cubics may miss by.
TEST_P(RayFamilies, AreTheRaysThatAreTracedOneByOne) {
  const support::CurvedOcean& ocean = GetParam();
  const RayTracer tracer(ocean.environment, 1000.0);
  const FanLimits limits{
      .lowest = -0.9, .highest = 0.9, .max_surface_bounces = 3, .max_bottom_bounces = 3};
  std::vector<ReceiverPoint> grid;
  for (int i = 1; i <= 8; ++i)
    for (int k = 0; k < 60; ++k) grid.push_back({ocean.range * (0.1 + 0.11 * i), 12.0 + 6.5 * k});
  const auto found = marching_eigenrays(tracer, 0.0, ocean.source_depth, grid, limits);
  int compared = 0;
  for (std::size_t i = 7; i < grid.size(); i += 37) {
    const Arrivals alone =
        marching_eigenrays(tracer, 0.0, ocean.source_depth, std::span(&grid[i], 1), limits)[0];
    double strongest = 0.0;
    for (const Arrival& a : alone) strongest = std::max(strongest, std::abs(a.amplitude));
    const Arrivals& here = found[i];
    for (const Arrival& a : alone) {
      if (std::abs(a.amplitude) < 1e-3 * strongest)
        continue;  // the search may leave out faint ones
      const auto same =
          std::min_element(here.begin(), here.end(), [&](const auto& x, const auto& y) {
            const auto off = [&](const Arrival& b) {
              const bool path =
                  b.surface_bounces == a.surface_bounces && b.bottom_bounces == a.bottom_bounces;
              return path ? std::abs(b.launch_elevation - a.launch_elevation) : 1e3;
            };
            return off(x) < off(y);
          });
      ASSERT_NE(same, here.end());
      const double miss = std::abs(a.q / std::cos(a.arrival_elevation));
      EXPECT_LT(std::abs(same->launch_elevation - a.launch_elevation) * miss, 1e-5)
          << ocean.name << " at " << grid[i].range << ", " << grid[i].depth;
      EXPECT_NEAR(same->delay, a.delay, 1e-8);
      EXPECT_NEAR(same->arrival_elevation, a.arrival_elevation, 1e-5);
      EXPECT_LT(std::abs(same->amplitude - a.amplitude), 1e-4 * std::abs(a.amplitude));
      EXPECT_NEAR(same->path_length, a.path_length, 1e-3);
      EXPECT_EQ(same->caustics, a.caustics);
      EXPECT_EQ(same->upper_turns, a.upper_turns);
      EXPECT_EQ(same->lower_turns, a.lower_turns);
      ASSERT_EQ(same->bounces.size(), a.bounces.size());
      for (std::size_t k = 0; k < a.bounces.size(); ++k) {
        EXPECT_EQ(same->bounces[k].boundary, a.bounces[k].boundary);
        EXPECT_NEAR(same->bounces[k].range, a.bounces[k].range, 1e-2);
        EXPECT_NEAR(same->bounces[k].grazing, a.bounces[k].grazing, 1e-4);
      }
      ++compared;
    }
    // and the other way round: families invent none
    const auto strong = [&](const Arrivals& arrivals) {
      return std::count_if(arrivals.begin(), arrivals.end(), [&](const Arrival& a) {
        return std::abs(a.amplitude) >= 1e-3 * strongest;
      });
    };
    EXPECT_EQ(strong(here), strong(alone)) << grid[i].range << ", " << grid[i].depth;
  }
  EXPECT_GT(compared, 40);
}

// Through values and slopes of x⁹ at five places there is one polynomial of degree nine: x⁹.
TEST(OsculatingPolynomial, IsExactToItsDegree) {
  const std::array<double, 5> at = {0.0, 0.25, 0.5, 0.75, 1.0};
  std::array<double, 5> value{}, slope{};
  for (std::size_t i = 0; i < 5; ++i) {
    value[i] = std::pow(at[i], 9);
    slope[i] = 9.0 * std::pow(at[i], 8);
  }
  const OsculatingPolynomial<5> p(at, value, slope);
  const OsculatingPolynomial<5> q(
      at, {0.0, std::pow(0.25, 4), std::pow(0.5, 4), std::pow(0.75, 4), 1.0});
  for (const double t : {-0.1, 0.1, 0.6, 0.93}) {
    EXPECT_NEAR(p.at(t).value, std::pow(t, 9), 1e-13);
    EXPECT_NEAR(p.at(t).slope, 9.0 * std::pow(t, 8), 1e-12);
    EXPECT_NEAR(q.at(t).value, std::pow(t, 4), 1e-14);
    EXPECT_NEAR(q.at(t).slope, 4.0 * std::pow(t, 3), 1e-13);
  }
}

}  // namespace
}  // namespace asdic::detail
