#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "reverb/pairs/scattering_sheet.h"
#include "sonar/paths/shared_propagation.h"
#include "sonar/ping/run_pings.h"
#include "sonar/reverberation/reverberation_fields.h"
#include "support/map_of.h"
#include "support/reverberant_sea.h"
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

/// Today's transect, and the same as a map.
struct SlopeAsBoth {
  Transect transect{.x = -200.0, .y = 100.0, .bearing = radians(30.0)};
  Environment along = over_sand(summer(), 900.0);
  std::shared_ptr<const Area> area;

  /// \param front  the water varies along the transect as well, and has no map
  explicit SlopeAsBoth(bool front = false) {
    Environment rest = over_sand(summer(), 900.0);
    if (front)
      rest.section = SoundSpeedSection(
          std::vector{-3e3, 1e3, 6e3}, std::vector{0.0, 100.0, 1500.0},
          std::vector{1500.0, 1495.0, 1510.0, 1520.0, 1500.0, 1510.0, 1525.0, 1498.0, 1512.0});
    along = rest;
    along.bottom.shape = BoundaryShape(std::vector{-25e3, 25e3}, std::vector{1400.0, 400.0},
                                       ShapeInterpolation::piecewise_linear);
    area = std::make_shared<const Area>(
        Area::Maps{.floor = floor_of(30e3, 250.0,
                                     [this](double x, double y) {
                                       return along.bottom.depth_at(transect.range_of(x, y));
                                     })},
        rest, AreaSettings{}, transect);
  }
  SlopeAsBoth(const SlopeAsBoth&) = delete;
  SlopeAsBoth& operator=(const SlopeAsBoth&) = delete;

  /// Paths over 6 km along a bearing [deg]: of the transect and of the map.
  [[nodiscard]] std::pair<Arrivals, Arrivals> paths(double bearing, int dimension) const {
    const Vec3 from(500.0, 1200.0, 150.0);
    const Vec3 to = from + Vec3(6000.0 * std::sin(radians(bearing)),
                                6000.0 * std::cos(radians(bearing)), -60.0);
    const PropagationPaths of_transect(along, transect, nullptr, nullptr,
                                       volume_of(along, transect, nullptr, dimension)),
        of_area(along, transect, area, nullptr, volume_of(along, transect, area, dimension));
    return {of_transect.find(from, to, 4000.0, some), of_area.find(from, to, 4000.0, some)};
  }
};

// Along it, across it and between.
TEST(Area, ASlopeIsTheTransect) {
  const SlopeAsBoth slope;
  for (const double bearing : {30.0, 75.0, 119.0, 210.0}) {
    SCOPED_TRACE(bearing);
    const auto [transect, area] = slope.paths(bearing, 2);
    expect_alike(area, transect, 1e-6, 0.05);
  }
}

// Water of a section beside a map of the floor lies along the transect, whoever asks.
TEST(Area, ASectionBesideAMapIsTheTransects) {
  const SlopeAsBoth slope(true);
  for (const double bearing : {30.0, 75.0, 210.0}) {
    SCOPED_TRACE(bearing);
    const auto [transect, area] = slope.paths(bearing, 2);
    expect_alike(area, transect, 1e-6, 0.05);
    const Vec3 place(2000.0, -700.0, 80.0);
    const double range = slope.transect.range_of(place.x(), place.y());
    EXPECT_DOUBLE_EQ(slope.area->speed_at(place.x(), place.y(), place.z()).c,
                     sound_speed(slope.along, range, place.z()).c);
  }
  const auto [transect, area] = slope.paths(75.0, 3);
  expect_alike(area, transect, 1e-6, 0.05);
}

// In three dimensions, across the slope, where rays are turned sideways.
TEST(Area, ASlopeInThreeDimensionsIsTheTransects) {
  const SlopeAsBoth slope;
  for (const double bearing : {75.0, 120.0}) {
    SCOPED_TRACE(bearing);
    const auto [transect, area] = slope.paths(bearing, 3);
    expect_alike(area, transect, 1e-6, 0.05);
    double sideways = 0.0;
    for (const Arrival& a : area) sideways = std::max(sideways, std::abs(a.launch_deflection));
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

/// ∫ μ sin²θ/d⁴ dA over what a straight ray sees of the floor, piece by piece: where, when and how
/// much. \param visit  of x and y from the source, delay and power
template <class Visit>
void integrate(const Vec3& source, const std::function<Slope(double, double)>& floor,
               double furthest, const Visit& visit) {
  constexpr double dr = 10.0;
  constexpr int around = 720;
  for (double r = 0.5 * dr; r < furthest; r += dr)
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
      visit(x, y, 2.0 * d / speed, mu * sine * sine / std::pow(d, 4) * area);
    }
}

Sectors integral(const Vec3& source, const std::function<Slope(double, double)>& floor) {
  Sectors sectors;
  integrate(source, floor, far, [&](double x, double y, double delay, double power) {
    sectors.add(x, y, delay, power);
  });
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

// The level that a ping expects is looked for in some of the sectors of every ring. Beside a cone
// one side is up to 20 dB louder than the other: all bearings must have their turn. 0.3 dB.
TEST(Area, ExpectedReverberationIsThatOfAllBearings) {
  Scenario s = support::even_sea();
  s.environment = over_sand(SoundSpeedProfile::isovelocity(speed), 4000.0);
  s.area = area_of(
      s.environment, [](double x, double y) { return cone(x, y).depth; }, 100.0);
  const Vec3 source(-3000.0, 500.0, 500.0);
  s.platforms[0].track.start.position = source;
  s.transmitters[0].beam = LineBeam{.taper = Taper::omnidirectional};
  s.pulse = {.waveform = Cw{}, .duration = 0.2, .window = PulseWindow::none};
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{.mu_db = db_from_power(mu)};
  s.reverberation.azimuths = 72;
  s.pings.recording_duration = 7.0;
  const support::ReverberantSea sea(s);
  const PingReverberation ping = sea.ping(1);
  for (const double t : {3.5, 4.5, 5.5, 6.5}) {
    double received = 0.0;
    integrate(source, cone, 5500.0, [&](double, double, double delay, double power) {
      if (delay < t && delay > t - 0.2) received += power;
    });
    EXPECT_NEAR(ping.expected_db(t), 220.0 + db_from_power(received), 0.3) << t;
  }
}

// Half of the map is land, where volume and kinds have no values: nobody asks for them there, and
// what sound meets is the coast.
TEST(Area, LandNeedsNoWaterAndNoKinds) {
  const double none = std::nan("");
  const auto beach = [](double x, double) { return 300.0 - 0.1 * x; };
  const auto at_sea = [&](double x, double y) { return beach(x, y) > -400.0; };
  const support::MapOf volume(-30e3, 30e3, 31, 2, [&](double x, double y, std::size_t level) {
    return at_sea(x, y) ? 1500.0 + 5.0 * double(level) : none;
  });
  const support::MapOf kinds(-30e3, 30e3, 601, 1, [&](double x, double y, std::size_t) {
    return beach(x, y) > 0.0 ? 4.0 : none;
  });
  const MapFrame frame = MapFrame::projected(0.0, 0.0);
  const Environment ocean = over_sand(SoundSpeedProfile::isovelocity(speed), 300.0);
  const auto area = std::make_shared<const Area>(
      Area::Maps{.floor = floor_of(30e3, 100.0, beach),
                 .water = WaterMap(volume.grid, frame, {0.0, 300.0}, {"volume"}),
                 .seabed = ClassMap(kinds.grid, frame, {"kinds"}),
                 .materials = {{4, FluidHalfSpace{}}}},
      ocean);
  const PropagationPaths paths(area->section({0.0, 0.0}, 0.0, 10e3), {}, area);
  const auto fan = BoundaryFans(paths).around(
      {0.0, 0.0, 50.0}, GroundLevel(BoundaryKind::bottom),
      {.sectors = 8, .spacing = 50.0, .max_range = 20e3, .frequency = 4000.0, .limits = some});
  const auto furthest = [&](double bearing) {
    double r = 0.0;
    const FanPlane& plane = fan->towards(radians(bearing));
    for (std::size_t cell = 0; cell < plane.paths->cells(); ++cell)
      for (const BoundaryPath& path : plane.paths->paths(cell))
        if (std::abs(path.amplitude) > 0.0) r = plane.paths->range(cell);
    return r;
  };
  EXPECT_LT(furthest(112.0), 3500.0);  // the coast is 3 km east
  EXPECT_GT(furthest(292.0), 10e3);
}

}  // namespace
}  // namespace asdic::detail
