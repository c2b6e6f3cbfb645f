// Rays in three dimensions over maps, in a lens of water and in a wedge that ends: what searches
// share and skip changes no path.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "core/geometry.h"
#include "raytrace/propagation.h"
#include "raytrace/volume/area_volume.h"
#include "raytrace/volume/floor_blocks.h"
#include "raytrace/volume/volume_eigenrays.h"
#include "support/deep.h"
#include "support/volume_oceans.h"

namespace asdic::detail {
namespace {

ScalarMap map_of(double step, MapInterpolation interpolation, bool uneven,
                 const std::function<double(double, double)>& depth) {
  std::vector<double> places;
  for (int i = -80; i <= 80; ++i) places.push_back(step * (i + (uneven ? 0.3 * (i % 3) : 0.0)));
  std::vector<float> values;
  for (const double y : places)
    for (const double x : places) values.push_back(float(-depth(x, y)));
  const std::size_t columns = places.size();
  auto grid = std::make_shared<MapGrid>(
      MapAxis("x", places), MapAxis("y", places), 1,
      [values, columns](const MapGrid::Window& w, std::span<float> into) {
        for (std::size_t j = 0; j < w.rows; ++j)
          for (std::size_t i = 0; i < w.columns; ++i)
            into[j * w.columns + i] = values[(w.row + j) * columns + w.column + i];
      });
  return {std::move(grid), MapFrame::projected(0.0, 0.0), interpolation, -1.0, {"depth"}};
}

// What a ray skips must hold no floor: bounds of boxes against the floor at 400 places in each.
TEST(FloorBlocks, NoFloorIsShallowerThanItsBlock) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const MapInterpolation kind : {MapInterpolation::bicubic, MapInterpolation::faceted})
    for (const bool uneven : {false, true}) {
      std::vector<double> rough(4096);
      for (double& one : rough) one = 60.0 * part(random);
      const auto depth = [&](double x, double y) {
        const auto of = [](double a) { return std::size_t(std::abs(std::lround(a / 60.0))) % 64; };
        return 100.0 + rough[of(x) * 64 + of(y)];
      };
      const ScalarMap map = map_of(100.0, kind, uneven, depth);
      const FloorBlocks blocks(map, 0.1);
      double closest = infinity;
      for (int i = 0; i < 200; ++i) {
        const Vec2 low(12000.0 * (part(random) - 0.5), 12000.0 * (part(random) - 0.5)),
            size(700.0 * part(random), 700.0 * part(random));
        double least = infinity;
        for (int j = 0; j < 400; ++j)
          least = std::min(
              least,
              map.at(low.x() + size.x() * part(random), low.y() + size.y() * part(random)).value);
        const double bound = blocks.shallowest(low, low + size);
        EXPECT_LE(bound, least);
        closest = std::min(closest, least - bound);
      }
      EXPECT_LT(closest, 25.0);  // of 60 m of relief: a bound that helps
    }
  const ScalarMap map =
      map_of(100.0, MapInterpolation::bicubic, false, [](double, double) { return 100.0; });
  EXPECT_EQ(FloorBlocks(map, 0.1).shallowest({-1e6, 0.0}, {-1e6, 1.0}), -infinity);
  EXPECT_EQ(FloorBlocks(map, 0.1).shallowest({-1e5, 0.0}, {1e5, 1.0}), -infinity);
}

std::shared_ptr<const Area> seamount() {
  Environment ocean;
  ocean.water =
      SoundSpeedProfile::table(std::vector{0.0, 60.0, 300.0, 1100.0},
                               std::vector{1518.0, 1512.0, 1494.0, 1501.0}, Interpolation::spline);
  // mud: a few bounces are all that is heard
  ocean.bottom = {.depth = 1000.0, .material = FluidHalfSpace{.speed = 1480.0, .density = 1300.0}};
  return std::make_shared<const Area>(
      Area::Maps{.floor = map_of(150.0, MapInterpolation::bicubic, false,
                                 [](double x, double y) {
                                   const double dx = x - 1500.0, dy = y - 2500.0;
                                   return 1000.0 -
                                          600.0 * std::exp(-(dx * dx + dy * dy) / (2.0 * 9e5));
                                 })},
      ocean);
}

// A fan that many receivers share finds for each what its own fan does.
TEST(VolumeFan, ServesEveryReceiverAsIfItWereAlone) {
  const AreaVolume volume(seamount());
  const VolumeTracer tracer(volume, 1000.0);
  const Vec3 from(0.0, 0.0, 80.0);
  std::vector<Vec3> receivers;
  for (const double range : {1500.0, 6000.0})
    for (const double depth : {40.0, 350.0})
      receivers.emplace_back(range * std::sin(0.2), range * std::cos(0.2), depth);
  const PathLimits limits{.max_surface_bounces = 1, .max_bottom_bounces = 1};
  const VolumeFan fan(tracer, from, receivers, limits);
  double deflected = 0.0;
  for (const Vec3& to : receivers) {
    VolumeSearchReport report;
    const Arrivals shared = volume_eigenrays(fan, to, &report),
                   alone = volume_eigenrays(tracer, from, to, limits);
    EXPECT_EQ(report.given_up, 0u);
    EXPECT_GE(alone.size(), 3u);
    ASSERT_EQ(shared.size(), alone.size()) << to.y() << ' ' << to.z();
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_NEAR(shared[i].delay, alone[i].delay, 1e-9);
      EXPECT_LT(std::abs(shared[i].amplitude - alone[i].amplitude),
                1e-4 * std::abs(alone[i].amplitude));
      deflected = std::max(deflected, std::abs(alone[i].arrival_deflection));
    }
  }
  EXPECT_GT(deflected, radians(2.0));  // the seamount is heard from aside
  // What is left for cost is told.
  VolumeSearchReport report;
  static_cast<void>(volume_eigenrays(fan, receivers.back(), &report, {.most_rays = 0}));
  EXPECT_GT(report.given_up, 0u);
}

// A field's paths are less finely refined than arrivals, and share a fan: the sum is the same.
TEST(VolumeRun, AFieldOverASeamountIsTheSumOfItsPaths) {
  if (!support::deep()) GTEST_SKIP() << "ASDIC_DEEP=1: ten seconds";
  PropagationCase run;
  const auto area = seamount();
  run.on_area = PropagationCase::OnArea{.area = area, .bearing = 0.2};
  run.environment = area->section(Vec2::Zero(), 0.2, 4000.0);
  run.dimension = 3;
  run.frequency = 300.0;
  run.source_depths = {80.0};
  run.receivers = {.depths = {40.0, 200.0}, .ranges = {900.0, 1900.0}};
  run.beams.lowest = -radians(20.0);
  run.beams.highest = radians(20.0);
  run.box_range = 4000.0;
  run.box_depth = 1200.0;
  std::atomic<double> last = -1.0;
  const PropagationResult field = asdic::detail::run(run, [&](double share) {
    EXPECT_LE(share, 1.0);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  run.task = Task::arrivals;
  const PropagationResult paths = asdic::detail::run(run);
  for (std::size_t i = 0; i < 4; ++i) {
    std::complex<double> sum = 0.0;
    for (const Arrival& a : paths.arrivals[i])
      sum += a.amplitude * std::polar(1.0, -2.0 * pi * run.frequency * a.delay);
    EXPECT_GE(paths.arrivals[i].size(), 2u);
    EXPECT_LT(std::abs(std::complex<double>(field.field[i]) - sum), 0.01 * std::abs(sum)) << i;
  }
}

/// A horizontal lens of faster water, Gaussian in all directions: an eddy.
class Eddy : public VolumeOcean {
 public:
  static constexpr double c0 = 1500.0, faster = 25.0, width = 8000.0, height = 500.0;
  VolumeSpeed speed(const Vec3& place, std::size_t) const override {
    const Vec3 d = place - Vec3(6000.0, 22000.0, 900.0);
    const Vec3 per(1.0 / (width * width), 1.0 / (width * width), 1.0 / (height * height));
    const Vec3 u = d.cwiseProduct(per);
    const double g = faster * std::exp(-0.5 * d.dot(u));
    VolumeSpeed found{.c = c0 + g, .gradient = -g * u};
    found.hessian = g * (u * u.transpose());
    for (int i = 0; i < 3; ++i) found.hessian(i, i) -= g * per[i];
    return found;
  }
  // |∇c| ≤ 25/(8000·√e) along the horizon
  double sideways_bending() const override { return faster / width * 0.61 / (c0 * c0); }
  VolumeFloor floor(double, double) const override { return {.depth = 5000.0}; }
  const BoundaryMaterial& floor_material(double, double) const override { return rigid_; }
  double floor_spacing() const override { return infinity; }
  double shallowest_floor() const override { return 5000.0; }
  double deepest_floor() const override { return 5000.0; }
  double steepest_floor() const override { return 0.0; }

 private:
  BoundaryMaterial rigid_ = Rigid{};
};

// Truth: the ray equations over arc length by SciPy's DOP853 (rtol 10⁻¹³), shot to within 10⁻⁸ m.
TEST(VolumeEigenrays, ThroughAnEddyAreThoseOfAnotherIntegrator) {
  struct Truth {
    Vec3 to;
    double delay, launch_deflection, launch_elevation, arrival_deflection, arrival_elevation;
  };
  const Eddy sea;
  const VolumeTracer tracer(sea, 500.0);
  const Vec3 from(0.0, 0.0, 800.0);
  for (const Truth& t : {Truth{{0.0, 40000.0, 1100.0},
                               26.503251466,
                               0.010291343,
                               -0.008224327,
                               -0.012302556,
                               -0.021325030},
                         {{12000.0, 38000.0, 700.0},
                          26.353684618,
                          -0.001903140,
                          -0.008281254,
                          0.002462082,
                          0.025027093},
                         {{-3000.0, 25000.0, 900.0},
                          16.700428896,
                          0.005457218,
                          -0.007896667,
                          -0.011768310,
                          -0.000794572}}) {
    const Arrivals found =
        volume_eigenrays(tracer, from, t.to, {.max_surface_bounces = 0, .max_bottom_bounces = 0});
    const auto path =
        std::min_element(found.begin(), found.end(), [&](const Arrival& a, const Arrival& b) {
          return std::abs(a.launch_elevation - t.launch_elevation) <
                 std::abs(b.launch_elevation - t.launch_elevation);
        });
    ASSERT_NE(path, found.end());
    EXPECT_NEAR(path->delay, t.delay, 1e-7);  // 1 to 10 µs are asked for
    EXPECT_NEAR(path->launch_deflection, t.launch_deflection, 1e-6);
    EXPECT_NEAR(path->launch_elevation, t.launch_elevation, 1e-6);
    EXPECT_NEAR(path->arrival_deflection, t.arrival_deflection, 1e-6);
    EXPECT_NEAR(path->arrival_elevation, t.arrival_elevation, 1e-6);
  }
}

/// A wedge of 11.25° to the east whose floor is level from 200 m of depth on.
struct Truncated {
  double slope = std::tan(pi / 16.0);
  [[nodiscard]] double edge() const { return 200.0 / slope; }
  VolumeFloor operator()(double x, double) const {
    if (x >= edge()) return {.depth = 200.0, .facet = 2};
    return {.depth = slope * x, .gradient = {slope, 0.0}, .facet = 1};
  }
};

class TruncatedWedge : public support::ProfiledVolume<Truncated> {
 public:
  TruncatedWedge()
      : ProfiledVolume(SoundSpeedProfile::isovelocity(1500.0), Truncated{}, -infinity, 200.0,
                       Truncated{}.slope, 100.0) {}
  WaterCell water_cell(const Vec3&, const Vec3&) const override { return {.uniform = true}; }
};

// Nothing that touches the level floor comes sooner than a way to its edge and back: until then
// every path is one of the whole wedge's, whose paths are images (perfect_wedge.cpp).
TEST(TruncatedWedge, IsTheWedgeUntilItsEndIsHeard) {
  const TruncatedWedge sea;
  const support::PlaneWedge whole(pi / 16.0, 0.5 * pi, Rigid{});
  const double edge = Truncated{}.edge();
  const Vec3 from(560.0, 0.0, 60.0), to(480.0, 500.0, 40.0);
  const Vec3 beyond(2.0 * edge - to.x(), to.y(), to.z());
  const double heard = (beyond - from).norm() / 1500.0;
  const PathLimits limits{.max_surface_bounces = 16, .max_bottom_bounces = 16};
  const Arrivals images = volume_eigenrays(VolumeTracer(whole, 1000.0), from, to, limits),
                 found = volume_eigenrays(VolumeTracer(sea, 1000.0), from, to, limits);
  const auto before = [&](const Arrivals& all) {
    return std::size_t(
        std::count_if(all.begin(), all.end(), [&](const Arrival& a) { return a.delay < heard; }));
  };
  ASSERT_EQ(before(found), before(images));
  EXPECT_GE(before(images), 8u);
  EXPECT_GT(found.size(), before(found));
  for (std::size_t i = 0; i < before(images); ++i) {
    EXPECT_NEAR(found[i].delay, images[i].delay, 1e-9);
    EXPECT_LT(std::abs(found[i].amplitude - images[i].amplitude),
              1e-6 * std::abs(images[i].amplitude));
    EXPECT_NEAR(found[i].arrival_deflection, images[i].arrival_deflection, 1e-7);
  }
}

}  // namespace
}  // namespace asdic::detail
