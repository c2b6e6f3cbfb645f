#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "reverb/pairs/scattering_sheet.h"
#include "sonar/paths/shared_propagation.h"
#include "sonar/ping/run_pings.h"
#include "sonar/reverberation/reverberation_fields.h"
#include "support/map_of.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

using support::floor_of;

SoundSpeedProfile summer() {
  return SoundSpeedProfile::table(std::vector{0.0, 60.0, 200.0, 900.0},
                                  std::vector{1520.0, 1516.0, 1496.0, 1500.0},
                                  Interpolation::c_linear);
}

Environment over_sand(SoundSpeedProfile water, double depth) {
  Environment ocean;
  ocean.water = std::move(water);
  ocean.bottom = {.depth = depth, .material = FluidHalfSpace{}};
  return ocean;
}

std::shared_ptr<const Area> area_of(const Environment& ocean,
                                    std::function<double(double, double)> depth,
                                    double step = 250.0) {
  return std::make_shared<const Area>(Area::Maps{.floor = floor_of(30e3, step, std::move(depth))},
                                      ocean);
}

constexpr PathLimits some{.max_surface_bounces = 2, .max_bottom_bounces = 2};

void expect_alike(const Arrivals& a, const Arrivals& b, double delay, double db) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].delay, b[i].delay, delay);
    EXPECT_NEAR(db_from_amplitude(std::abs(a[i].amplitude) / std::abs(b[i].amplitude)), 0.0, db);
    EXPECT_NEAR(std::arg(a[i].amplitude / b[i].amplitude), 0.0, 0.02);
  }
}

// A floor that rises by a millimetre in a kilometre is marched, one that is flat is layered: the
// millimetres make 3e-6 m of way a bounce and kilometre.
TEST(Area, AFlatAreaIsTheLayeredOcean) {
  const Environment ocean = over_sand(summer(), 900.0);
  const PropagationPaths layered(ocean, {});
  for (const double slope : {0.0, 1e-7}) {
    const auto area = area_of(ocean, [&](double x, double) { return 900.0 - slope * x; });
    const PropagationPaths paths(ocean, {}, area);
    EXPECT_FALSE(paths.layered());
    for (const Vec3& to : {Vec3(4000.0, 1000.0, 100.0), Vec3(-9000.0, 12000.0, 30.0)}) {
      const Vec3 from(500.0, 1200.0, 150.0);
      expect_alike(paths.find(from, to, 4000.0, some), layered.find(from, to, 4000.0, some), 1e-6,
                   0.05);
    }
  }
}

// Today's transect, as a map: along it, across it and between.
TEST(Area, ASlopeIsTheTransect) {
  const Transect transect{.x = -200.0, .y = 100.0, .bearing = radians(30.0)};
  Environment along = over_sand(summer(), 900.0);
  along.bottom.shape = BoundaryShape(std::vector{-25e3, 25e3}, std::vector{1400.0, 400.0},
                                     ShapeInterpolation::piecewise_linear);
  const auto area = area_of(over_sand(summer(), 900.0), [&](double x, double y) {
    return along.bottom.depth_at(transect.range_of(x, y));
  });
  const PropagationPaths transects(along, transect), areas(along, transect, area);
  for (const double bearing : {30.0, 75.0, 119.0, 210.0}) {
    const Vec3 from(500.0, 1200.0, 150.0);
    const Vec3 to = from + Vec3(6000.0 * std::sin(radians(bearing)),
                                6000.0 * std::cos(radians(bearing)), -60.0);
    SCOPED_TRACE(bearing);
    expect_alike(areas.find(from, to, 4000.0, some), transects.find(from, to, 4000.0, some), 1e-6,
                 0.05);
  }
}

// In three dimensions, across the slope, where rays are turned sideways: the transect as a volume.
TEST(Area, ASlopeInThreeDimensionsIsTheTransects) {
  const Transect transect{.x = -200.0, .y = 100.0, .bearing = radians(30.0)};
  Environment along = over_sand(summer(), 900.0);
  along.bottom.shape = BoundaryShape(std::vector{-25e3, 25e3}, std::vector{1400.0, 400.0},
                                     ShapeInterpolation::piecewise_linear);
  const auto area = area_of(over_sand(summer(), 900.0), [&](double x, double y) {
    return along.bottom.depth_at(transect.range_of(x, y));
  });
  const PropagationPaths transects(along, transect, nullptr, nullptr,
                                   volume_of(along, transect, nullptr, 3)),
      areas(along, transect, area, nullptr, volume_of(along, transect, area, 3));
  ASSERT_NE(areas.volume(), nullptr);
  for (const double bearing : {75.0, 120.0}) {
    const Vec3 from(500.0, 1200.0, 150.0);
    const Vec3 to = from + Vec3(6000.0 * std::sin(radians(bearing)),
                                6000.0 * std::cos(radians(bearing)), -60.0);
    SCOPED_TRACE(bearing);
    const Arrivals found = areas.find(from, to, 4000.0, some);
    expect_alike(found, transects.find(from, to, 4000.0, some), 1e-6, 0.05);
    double sideways = 0.0;
    for (const Arrival& a : found) sideways = std::max(sideways, std::abs(a.launch_deflection));
    EXPECT_GT(sideways, 1e-3);
  }
}

/// Backscatter of the direct path alone, by 10° of bearing and delay of half a second, of a floor
/// in uniform water.
struct Sectors {
  static constexpr std::size_t bearings = 36, delays = 12;
  std::array<std::array<double, delays>, bearings> power{};

  void add(double x, double y, double delay, double received) {
    const double turn = std::atan2(x, y) / (2.0 * pi);
    const auto sector = std::min(bearings - 1, std::size_t((turn - std::floor(turn)) * bearings));
    const auto bin = static_cast<std::size_t>(delay / 0.5);
    if (bin < delays) power[sector][bin] += received;
  }
  [[nodiscard]] double all(std::size_t sector) const {
    double sum = 0.0;
    for (const double p : power[sector]) sum += p;
    return sum;
  }
};

struct Slope {
  double depth, x, y;
};

constexpr double speed = 1500.0, mu = 2e-3, far = 5000.0;

/// ∫ μ sin²θ/d⁴ dA over what a straight ray sees of the floor.
Sectors integral(const Vec3& source, const std::function<Slope(double, double)>& floor) {
  Sectors sectors;
  constexpr double dr = 10.0;
  constexpr int around = 720;
  for (double r = 0.5 * dr; r < far; r += dr)
    for (int i = 0; i < around; ++i) {
      const double bearing = 2.0 * pi * (i + 0.5) / around;
      const double x = r * std::sin(bearing), y = r * std::cos(bearing);
      const Slope here = floor(source.x() + x, source.y() + y);
      const double down = here.depth - source.z(), d = std::hypot(r, down);
      const double facet = std::sqrt(1.0 + here.x * here.x + here.y * here.y);
      const double sine = (down - x * here.x - y * here.y) / (d * facet);
      bool seen = sine > 0.0;
      for (double s = 0.02; seen && s < 1.0; s += 0.02)
        seen = floor(source.x() + s * x, source.y() + s * y).depth > source.z() + s * down - 1e-6;
      if (!seen) continue;
      const double area = facet * r * dr * 2.0 * pi / around;
      sectors.add(x, y, 2.0 * d / speed, mu * sine * sine / std::pow(d, 4) * area);
    }
  return sectors;
}

/// The same by the scatterers of a ping.
Sectors scattered(const Vec3& source, const std::shared_ptr<const Area>& area,
                  const Environment& ocean, int planes, double wide) {
  const PropagationPaths paths(ocean, {}, area);
  const BoundaryFans fans(paths);
  const PathLimits direct{.max_surface_bounces = 0, .max_bottom_bounces = 0};
  const auto fan = fans.around(source, GroundLevel(BoundaryKind::bottom),
                               {.sectors = planes,
                                .spacing = 20.0,
                                .wide = wide,
                                .max_range = far + 100.0,
                                .frequency = 4000.0,
                                .limits = direct,
                                .means = wide > 0.0});
  const BeamPattern pattern({.beam = LineBeam{.taper = Taper::omnidirectional}}, speed / 4000.0);
  SheetEnds ends{.source = {.position = source}, .receiver = {.position = source}};
  ends.source_speed = ends.receiver_speed = speed;
  const ScatteringSheet sheet(fan, fan, ScatteringSheet::Law(Lambert{.mu_db = db_from_power(mu)}),
                              ends, pattern);
  Sectors sectors;
  PathPairs pairs;
  constexpr double dr = 20.0;
  constexpr int around = 720;
  for (double r = 0.5 * dr; r < far; r += dr)
    for (int i = 0; i < around; ++i) {
      const double bearing = 2.0 * pi * (i + 0.5) / around;
      const Vec2 out = r * Vec2(std::sin(bearing), std::cos(bearing));
      sheet.pairs_at(source.head<2>() + out, pairs);
      for (const PathPair& pair : pairs.found)
        sectors.add(out.x(), out.y(), pair.delay,
                    std::norm(pair.amplitude) * pair.area * r * dr * 2.0 * pi / around);
    }
  return sectors;
}

void compare(const Sectors& truth, const Sectors& found) {
  for (std::size_t sector = 0; sector < Sectors::bearings; ++sector) {
    EXPECT_NEAR(db_from_power(found.all(sector) / truth.all(sector)), 0.0, 0.3) << sector;
    for (std::size_t bin = 0; bin < Sectors::delays; ++bin) {
      const double want = truth.power[sector][bin];
      if (want < 0.05 * truth.all(sector)) continue;
      EXPECT_NEAR(db_from_power(found.power[sector][bin] / want), 0.0, 0.3) << sector << ' ' << bin;
    }
  }
}

void compare_with_integral(const Vec3& source, const std::function<Slope(double, double)>& floor,
                           double step = 100.0) {
  const Environment ocean = over_sand(SoundSpeedProfile::isovelocity(speed), 4000.0);
  const auto area = area_of(
      ocean, [&](double x, double y) { return floor(x, y).depth; }, step);
  const Sectors truth = integral(source, floor);
  for (const double wide : {0.0, 50.0}) {  // every path; means, as pings take them
    SCOPED_TRACE(wide);
    compare(truth, scattered(source, area, ocean, 72, wide));
  }
}

// Lambert's law on the true facet, in 36 sectors: the slope across the plane counts.
TEST(Area, DirectReverberationOfASlopeIsTheIntegral) {
  const auto slope = [](double x, double y) {
    return Slope{.depth = 1500.0 + 0.2 * x + 0.1 * y, .x = 0.2, .y = 0.1};
  };
  compare_with_integral({0.0, 0.0, 300.0}, slope);
}

Slope cone(double x, double y) {
  const double r = std::hypot(x, y), height = 2400.0 - 0.4 * r;
  if (height <= 0.0) return {4000.0, 0.0, 0.0};
  return {4000.0 - height, 0.4 * x / r, 0.4 * y / r};
}

// Above its summit, and beside it, where its far side is in the shadow.
TEST(Area, DirectReverberationOfAConicalSeamountIsTheIntegral) {
  compare_with_integral({0.0, 0.0, 500.0}, cone);
  compare_with_integral({-3000.0, 500.0, 500.0}, cone);
}

}  // namespace
}  // namespace asdic::detail
