// Rays in three dimensions against rays in a plane, where both are right.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/volume/transect_volume.h"
#include "raytrace/volume/volume_eigenrays.h"
#include "support/deep.h"
#include "support/oceans.h"
#include "support/volume_oceans.h"

namespace asdic::detail {
namespace {

/// Every path of a plane is among those of the volume, and the other way round.
void expect_same(const Arrivals& plane, const Arrivals& volume, double seconds, double db) {
  EXPECT_EQ(volume.size(), plane.size());
  for (const Arrival& a : plane) {
    const auto b = std::find_if(volume.begin(), volume.end(), [&](const Arrival& v) {
      return v.surface_bounces == a.surface_bounces && v.bottom_bounces == a.bottom_bounces &&
             std::abs(v.launch_elevation - a.launch_elevation) < 2e-5 &&
             std::abs(v.delay - a.delay) < 1e-4;
    });
    if (b == volume.end()) {
      ADD_FAILURE() << "missed: " << a.delay << " s, " << degrees(a.launch_elevation) << " deg, "
                    << a.surface_bounces << '+' << a.bottom_bounces << " bounces, "
                    << db_from_amplitude(std::abs(a.amplitude)) << " dB";
      continue;
    }
    EXPECT_NEAR(b->delay, a.delay, seconds);
    EXPECT_NEAR(db_from_amplitude(std::abs(b->amplitude / a.amplitude)), 0.0, db)
        << degrees(a.launch_elevation) << " deg, " << a.surface_bounces << '+' << a.bottom_bounces;
    EXPECT_NEAR(std::arg(b->amplitude / a.amplitude), 0.0, 1e-4)
        << degrees(a.launch_elevation) << " deg";
    EXPECT_NEAR(b->arrival_elevation, a.arrival_elevation, 1e-5);
    EXPECT_NEAR(b->path_length, a.path_length, 1e-2);
    EXPECT_EQ(b->caustics, a.caustics) << degrees(a.launch_elevation) << " deg";
    EXPECT_EQ(b->upper_turns, a.upper_turns);
    EXPECT_EQ(b->lower_turns, a.lower_turns);
    EXPECT_NEAR(b->launch_deflection, 0.0, 1e-7);
    EXPECT_NEAR(b->arrival_deflection, 0.0, 1e-7);
    EXPECT_NEAR(b->absorption_db, a.absorption_db, 1e-5);
    EXPECT_EQ(b->bounces.size(), a.bounces.size());
  }
}

struct Leg {
  double heading_deg, source_depth, receiver_depth, range;
};

class LayeredVolume : public testing::TestWithParam<Leg> {};

Environment layered_sea(SoundSpeedProfile water) {
  Environment sea{.water = std::move(water)};
  sea.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  sea.absorption = Thorp{};
  return sea;
}

// 1 µs and 0.01 dB are asked for.
TEST_P(LayeredVolume, IsThePlanesUnderAnyHeading) {
  const Leg& leg = GetParam();
  std::vector<double> z = support::samples(0.0, 5000.0, 26), c;
  for (const double depth : z) c.push_back(SoundSpeedProfile::munk().at(depth).c);
  const Vec3 from(3000.0, -7000.0, leg.source_depth);
  const double heading = radians(leg.heading_deg);
  const Vec3 to = from + Vec3(leg.range * std::sin(heading), leg.range * std::cos(heading),
                              leg.receiver_depth - leg.source_depth);
  const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 3};
  for (const SoundSpeedProfile& water :
       {SoundSpeedProfile::munk(), SoundSpeedProfile::table(z, c, Interpolation::spline),
        SoundSpeedProfile::table(z, c, Interpolation::c_linear)}) {
    SCOPED_TRACE(water.munk_parameters() ? "Munk" : name(water.interpolation()));
    const Environment sea = layered_sea(water);
    const TransectVolume volume(sea, {.x = 100.0, .y = 200.0, .bearing = radians(25.0)});
    VolumeSearchReport report;
    const Arrivals found =
        volume_eigenrays(VolumeTracer(volume, 1500.0), from, to, limits, &report);
    EXPECT_EQ(report.unfinished, 0u);
    expect_same(
        EigenraySolver(sea).find(leg.source_depth, leg.receiver_depth, leg.range, 1500.0, limits),
        found, 1e-6, 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(, LayeredVolume,
                         testing::Values(Leg{0.0, 1000.0, 800.0, 50000.0},
                                         Leg{211.0, 300.0, 1500.0, 23000.0},
                                         Leg{77.0, 100.0, 100.0, 4000.0},
                                         Leg{140.0, 50.0, 2000.0, 500.0}));

// Layers of fish have sharp edges, at which absorption jumps in the middle of a step: rays of a
// duct that pass them many times lose what they lose in planes.
TEST(VolumeTracer, AbsorptionMayJump) {
  Environment sea = layered_sea(SoundSpeedProfile::table(std::array{0.0, 50.84, 152.52},
                                                         std::array{1500.0, 1488.0, 1501.0},
                                                         Interpolation::n2_linear));
  sea.bottom.depth = 152.0;
  sea.biology = {{.top = 25.42, .bottom = 50.84, .resonance = 200.0, .strength = 0.5}};
  const TransectVolume volume(sea, {.x = 0.0, .y = 0.0, .bearing = 0.0});
  const PathLimits limits{.max_surface_bounces = 0, .max_bottom_bounces = 0};
  const Vec3 from(0.0, 0.0, 31.77), to(-4337.3, -5755.8, 31.77);
  const Arrivals found = volume_eigenrays(VolumeTracer(volume, 200.0), from, to, limits);
  const Arrivals planes =
      EigenraySolver(sea).find(31.77, 31.77, separation(from, to).range, 200.0, limits);
  ASSERT_EQ(found.size(), planes.size());
  ASSERT_GE(found.size(), 3u);
  for (const Arrival& a : planes) {
    const auto b = std::find_if(found.begin(), found.end(), [&](const Arrival& v) {
      return std::abs(v.launch_elevation - a.launch_elevation) < 2e-5;
    });
    ASSERT_NE(b, found.end());
    EXPECT_GT(a.absorption_db, 10.0);
    EXPECT_NEAR(b->absorption_db, a.absorption_db, 1e-4);
  }
}

// Straight up and down a slope rays keep to the vertical plane, and the sea is the same beside it:
// N × 2D is right there, its amplitude, too, where spreading is that of a plane.
TEST(AlongTheTransect, IsTheMarchedPlane) {
  const Vec3 from(-400.0, 900.0, 50.0);
  const PathLimits limits{.max_surface_bounces = 2, .max_bottom_bounces = 2};
  for (const support::CurvedOcean& sea : support::curved_oceans()) {
    if (sea.environment.surface.shape) continue;  // refused
    if (!support::deep() && sea.name.starts_with("ridge under") && !sea.name.ends_with("spline"))
      continue;
    SCOPED_TRACE(sea.name);
    Environment ocean = sea.environment;
    ocean.bottom.material = FluidHalfSpace{};
    ocean.absorption = Thorp{};
    const double bearing = radians(63.0);
    // the source at range 0 of the transect
    const TransectVolume volume(ocean, {.x = from.x(), .y = from.y(), .bearing = bearing});
    const Vec3 to = from + Vec3(6000.0 * std::sin(bearing), 6000.0 * std::cos(bearing), 110.0);
    VolumeSearchReport report;
    expect_same(EigenraySolver(ocean).find(50.0, 160.0, 6000.0, 2000.0, limits),
                volume_eigenrays(VolumeTracer(volume, 2000.0), from, to, limits, &report), 1e-6,
                0.01);
  }
}

// Straight up a wedge of uniform water a plane whose spreading is that of a cylinder has the right
// delays and angles, and amplitudes that differ there and back by √(ξ_source/ξ_receiver). Those of
// three dimensions are the same both ways, and with plane spreading so are those of N × 2D.
TEST(AlongTheTransect, CylindersAreNotReciprocal) {
  const PathLimits limits{.max_surface_bounces = 2, .max_bottom_bounces = 2};
  Environment ocean{.water = SoundSpeedProfile::isovelocity(1500.0)};
  ocean.bottom = {.depth = 900.0, .material = Rigid{}};
  ocean.bottom.shape = BoundaryShape(std::vector{-5000.0, 9000.0}, std::vector{1300.0, 400.0},
                                     ShapeInterpolation::piecewise_linear);
  const TransectVolume volume(ocean, {});
  const Arrivals there = volume_eigenrays(VolumeTracer(volume, 1000.0), {0.0, 0.0, 50.0},
                                          {0.0, 6000.0, 160.0}, limits),
                 back = volume_eigenrays(VolumeTracer(volume, 1000.0), {0.0, 6000.0, 160.0},
                                         {0.0, 0.0, 50.0}, limits);
  expect_same(EigenraySolver(ocean).find(50.0, 160.0, 6000.0, 1000.0, limits), there, 1e-6, 0.01);
  ocean.spreading = Spreading::cylindrical;
  const Arrivals cylinder = EigenraySolver(ocean).find(50.0, 160.0, 6000.0, 1000.0, limits);
  Environment reversed = ocean;
  reversed.bottom.shape = ocean.bottom.shape->along(6000.0, -1.0);
  const Arrivals cylinder_back = EigenraySolver(reversed).find(160.0, 50.0, 6000.0, 1000.0, limits);
  ASSERT_EQ(there.size(), cylinder.size());
  ASSERT_EQ(there.size(), back.size());
  ASSERT_EQ(there.size(), cylinder_back.size());
  double most = 0.0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const Arrival& ray = there[i];
    EXPECT_NEAR(cylinder[i].delay, ray.delay, 1e-6);
    EXPECT_NEAR(cylinder[i].arrival_elevation, ray.arrival_elevation, 1e-6);
    EXPECT_NEAR(std::abs(back[i].amplitude / ray.amplitude), 1.0, 1e-6);
    const double ratio = std::abs(cylinder[i].amplitude / cylinder_back[i].amplitude);
    EXPECT_NEAR(ratio, std::sqrt(std::cos(ray.launch_elevation) / std::cos(ray.arrival_elevation)),
                1e-5);
    most = std::max(most, std::abs(ratio - 1.0));
  }
  EXPECT_GT(most, 0.01);
}

/// Hills and hollows under a profile that bends rays.
struct Hills {
  VolumeFloor operator()(double x, double y) const {
    VolumeFloor f{.depth = 600.0 + 0.02 * x - 0.01 * y, .gradient = {0.02, -0.01}};
    for (const auto& [height, x0, y0, width] : {std::array{70.0, 1500.0, 400.0, 900.0},
                                                {-50.0, 2600.0, 1800.0, 700.0},
                                                {90.0, 3300.0, -300.0, 1100.0},
                                                {30.0, 700.0, 1500.0, 500.0}}) {
      const Vec2 d = Vec2(x - x0, y - y0) / width;
      const double h = height * std::exp(-0.5 * d.squaredNorm());
      f.depth -= h;
      f.gradient += h / width * d;
      f.hessian += h / (width * width) * (Mat2::Identity() - d * d.transpose());
    }
    return f;
  }
};

using HillySea = support::ProfiledVolume<Hills>;

HillySea hilly_sea() {
  const std::vector<double> z = {0.0, 100.0, 250.0, 450.0, 900.0},
                            c = {1520.0, 1512.0, 1497.0, 1495.0, 1502.0};
  return {SoundSpeedProfile::table(z, c, Interpolation::spline),
          Hills{},
          300.0,
          800.0,
          0.35,
          400.0,
          FluidHalfSpace{}};
}

// The variational equations and what mirrors do to them against neighbours traced beside: central
// differences of 1e-5 rad have an error of their square, 1e-10 of the third derivative.
TEST(VolumeTracer, TubeIsThatOfItsNeighbours) {
  const HillySea sea = hilly_sea();
  const VolumeTracer tracer(sea, 1000.0);
  const Vec3 from(0.0, 0.0, 120.0), receiver(4000.0, 900.0, 200.0);
  VolumeLimits limits{.max_surface_bounces = 4, .max_bottom_bounces = 4};
  limits.longest = 9000.0;
  limits.tolerance = 1e-9;
  int compared = 0;
  for (const double elevation : {-40.0, -22.0, -9.0, 5.0, 17.0, 33.0})
    for (const double azimuth : {62.0, 80.0, 95.0}) {
      const Vec3 d = direction(radians(azimuth), radians(elevation));
      const Mat32 basis = launch_basis(d);
      VolumeRay ray, plus, minus;
      tracer.trace(from, d, receiver, limits, ray);
      for (int k = 0; k < 2; ++k) {
        constexpr double h = 1e-5;
        const Vec3 b = basis.col(k);
        tracer.trace(from, (d + h * b).normalized(), receiver, limits, plus);
        tracer.trace(from, (d - h * b).normalized(), receiver, limits, minus);
        const std::size_t legs = std::min({ray.legs.size(), plus.legs.size(), minus.legs.size()});
        for (std::size_t i = 0; i < legs; ++i) {
          const LegPass& at = ray.legs[i];
          if (plus.legs[i].history.key != at.history.key ||
              minus.legs[i].history.key != at.history.key || at.beyond > 0.0 ||
              plus.legs[i].beyond > 0.0 || minus.legs[i].beyond > 0.0)
            continue;
          // passes lie at different times: compare across the ray
          const Vec3 t = at.state.p.normalized();
          const auto across = [&](const Vec3& v) { return Vec3(v - t * t.dot(v)); };
          const Vec3 by_neighbours =
              across((plus.legs[i].state.x - minus.legs[i].state.x) / (2.0 * h));
          const Vec3 by_equations = across(at.state.x_launch.col(k));
          EXPECT_LT((by_neighbours - by_equations).norm(),
                    1e-4 * std::max(1000.0, by_equations.norm()))
              << elevation << " deg, " << azimuth << " deg, leg " << i;
          ++compared;
        }
      }
    }
  EXPECT_GT(compared, 30);
}

// The same way back: what is heard does not depend on who calls.
TEST(VolumeEigenrays, AreReciprocalOverHills) {
  const HillySea sea = hilly_sea();
  const VolumeTracer tracer(sea, 1000.0);
  const Vec3 a(0.0, 0.0, 120.0), b(4100.0, 900.0, 200.0);
  const PathLimits limits{.max_surface_bounces = 2, .max_bottom_bounces = 2};
  const Arrivals there = volume_eigenrays(tracer, a, b, limits),
                 back = volume_eigenrays(tracer, b, a, limits);
  EXPECT_GT(there.size(), 5u);
  EXPECT_EQ(there.size(), back.size());
  double deflected = 0.0;
  for (const Arrival& x : there) {
    const auto y = std::find_if(back.begin(), back.end(), [&](const Arrival& v) {
      return v.surface_bounces == x.surface_bounces && v.bottom_bounces == x.bottom_bounces &&
             std::abs(v.delay - x.delay) < 1e-6 &&
             std::abs(v.arrival_elevation + x.launch_elevation) < 1e-5;
    });
    if (y == back.end()) {
      ADD_FAILURE() << "no way back: " << x.delay << " s, " << x.surface_bounces << '+'
                    << x.bottom_bounces << ", " << degrees(x.launch_elevation) << " deg";
      continue;
    }
    EXPECT_NEAR(y->delay, x.delay, 1e-8);
    EXPECT_NEAR(y->launch_elevation, -x.arrival_elevation, 1e-6);
    EXPECT_NEAR(y->launch_deflection, x.arrival_deflection, 1e-6);
    EXPECT_NEAR(y->arrival_deflection, x.launch_deflection, 1e-6);
    // p of a unit source at 1 m is reciprocal but for the speeds at both ends, c of its tube
    EXPECT_NEAR(std::abs(y->amplitude / x.amplitude), 1.0, 1e-4);
    EXPECT_NEAR(std::arg(y->amplitude / x.amplitude), 0.0, 1e-4);
    deflected = std::max(deflected, std::abs(x.launch_deflection));
  }
  EXPECT_GT(deflected, radians(0.4));
}

/// A bowl whose main curvatures differ, under uniform water.
struct Bowl {
  double depth, radius_x, radius_y;
  VolumeFloor operator()(double x, double y) const {
    VolumeFloor f{.depth = depth - 0.5 * x * x / radius_x - 0.5 * y * y / radius_y,
                  .gradient = {-x / radius_x, -y / radius_y}};
    f.hessian << -1.0 / radius_x, 0.0, 0.0, -1.0 / radius_y;
    return f;
  }
};

class BowlSea : public support::ProfiledVolume<Bowl> {
 public:
  explicit BowlSea(const Bowl& bowl)
      : ProfiledVolume(SoundSpeedProfile::isovelocity(1500.0), bowl, -infinity, bowl.depth, 0.2,
                       200.0) {}
  WaterCell water_cell(const Vec3&, const Vec3&) const override { return {.uniform = true}; }
};

// A mirror of radius R sends what comes from a distance d to the focus 1/d + 1/d′ = 2/R. At h on
// the way back the wave has the widths w = d + h(1 − 2d/R) in both planes, |p| = 1/√|w₁w₂|, and
// every width that has become negative passed a caustic.
TEST(VolumeTracer, BowlsFocusAndTheirCausticsCount) {
  constexpr double bottom = 1000.0, d = 600.0;
  int counts[3] = {};
  for (const auto& [radius_x, radius_y] :
       {std::pair(5000.0, 3000.0), {500.0, 5000.0}, {450.0, 500.0}, {450.0, 450.0}})
    for (const double height : {150.0, 500.0, 950.0}) {
      const BowlSea sea({bottom, radius_x, radius_y});
      const VolumeTracer tracer(sea, 1000.0);
      VolumeRay ray;
      tracer.trace({0.0, 0.0, bottom - d}, Vec3::UnitZ(), {0.0, 0.0, bottom - height},
                   {.max_surface_bounces = 0, .max_bottom_bounces = 1}, ray);
      ASSERT_EQ(ray.legs.size(), 2u);
      const LegPass& up = ray.legs[1];
      EXPECT_NEAR(up.state.time, (d + height) / 1500.0, 1e-12);
      const double w1 = d + height * (1.0 - 2.0 * d / radius_x),
                   w2 = d + height * (1.0 - 2.0 * d / radius_y);
      EXPECT_NEAR(std::abs(tube_area(up.state)), std::abs(w1 * w2), 1e-6 * d * d);
      const int caustics = (w1 < 0.0 ? 1 : 0) + (w2 < 0.0 ? 1 : 0);
      EXPECT_EQ(up.history.caustics, caustics) << radius_x << ' ' << radius_y << ' ' << height;
      ++counts[caustics];
    }
  EXPECT_GT(counts[0], 0);
  EXPECT_GT(counts[1], 0);
  EXPECT_GT(counts[2], 0);  // two at once, where both radii are one
}

}  // namespace
}  // namespace asdic::detail
