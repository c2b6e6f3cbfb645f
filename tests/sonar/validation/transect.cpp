#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "raytrace/ocean/slice.h"
#include "sonar/ping/run_pings.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A wedge: 900 m deep south of the origin, rising to 300 m at 12 km along 30 degrees, under a
/// summer profile.
Scenario wedge() {
  Scenario s = support::thesis(SoundSpeedProfile::table(std::vector{0.0, 60.0, 200.0, 900.0},
                                                        std::vector{1520.0, 1516.0, 1496.0, 1500.0},
                                                        Interpolation::c_linear));
  s.environment.bottom = {.depth = 900.0, .material = FluidHalfSpace{}};
  s.environment.bottom.shape = BoundaryShape(std::vector{0.0, 12000.0}, std::vector{900.0, 300.0},
                                             ShapeInterpolation::piecewise_linear);
  s.transect = {.x = -200.0, .y = 100.0, .bearing = radians(30.0)};
  s.platforms[0].track.start.position = {500.0, 1200.0, 150.0};
  s.targets = {support::target({4000.0, 4000.0, 100.0}, 10.0)};
  s.transmitters[0].source_level_db = 220.0;
  s.pulse.duration = 0.1;
  s.arrays[0] = line_array(2, 0.1875, 0.0, 0.0);
  s.noise.law.reset();
  s.reverberation.enabled = false;
  s.propagation.max_surface_bounces = 2;
  s.propagation.max_bottom_bounces = 2;
  s.pings.recording_duration = 12.0;
  return s;
}

/// The plane through two places by hand: the sea floor where the line is, node by node.
EigenraySolver by_hand(const Scenario& s, const Vec3& from, const Vec3& to) {
  const Vec2 way = (to - from).head<2>(),
             unit(std::sin(s.transect.bearing), std::cos(s.transect.bearing));
  const double cosine = way.dot(unit) / way.norm();
  const double x0 = (from.head<2>() - Vec2(s.transect.x, s.transect.y)).dot(unit);
  std::vector<double> range, depth;
  for (const auto& [x, z] : {std::pair{0.0, 900.0}, std::pair{12000.0, 300.0}}) {
    range.push_back((x - x0) / cosine);
    depth.push_back(z);
  }
  if (cosine < 0.0) {
    std::reverse(range.begin(), range.end());
    std::reverse(depth.begin(), depth.end());
  }
  Environment plane = s.environment;
  plane.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  plane.bottom.depth = plane.bottom.shape->depth_at(0.0);
  return EigenraySolver(plane);
}

double range(const Vec3& a, const Vec3& b) { return (b - a).head<2>().norm(); }

Arrivals paths_by_hand(const Scenario& s, const Vec3& from, const Vec3& to) {
  return by_hand(s, from, to)
      .find(from.z(), to.z(), range(from, to), 4000.0, limits_of(s.propagation));
}

// Nothing moves: an echo is a path up the slope times a path down it, both found in planes written
// down by hand. Delays and levels to rounding of the nodes (10⁻¹² of 10⁴ m).
TEST(Transect, EchoFromUpslopeIsThePathsThereAndBack) {
  const Scenario s = wedge();
  const Vec3 source = s.platforms[0].track.start.position,
             target = s.targets[0].track.start.position;
  const Arrivals out = paths_by_hand(s, source, target), back = paths_by_hand(s, target, source);
  const PingRecord record = PingSimulator(s).simulate(1);
  ASSERT_GE(out.size(), 5U);
  ASSERT_EQ(record.echoes.size(), out.size() * back.size());
  for (const EchoPath& echo : record.echoes) {
    const Arrival &a = out[std::size_t(echo.outgoing)], &b = back[std::size_t(echo.returning)];
    EXPECT_NEAR(echo.received.delay, a.delay + b.delay, 1e-9);
    const std::complex<double> amplitude = a.amplitude * b.amplitude * amplitude_from_db(10.0);
    EXPECT_LT(std::abs(echo.received.amplitude - amplitude), 1e-6 * std::abs(amplitude));
    EXPECT_NEAR(echo.level_db, 220.0 + db_from_amplitude(std::abs(amplitude)), 1e-5);
  }
}

// The way back is the way out reversed, though every leg was searched in a plane of its own: delays
// to 1e-9 s, amplitudes to 1e-5, for they are derivatives. In a sea that is the same all around
// each source (spreading = "cylindrical") reversed tubes differ in width across the plane by
// ξ_source/ξ_receiver, for over a slope a ray's horizontal slowness ξ changes; amplitudes by its
// root.
void expect_reversed(Spreading spreading) {
  Scenario s = wedge();
  s.environment.spreading = spreading;
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  const Arrivals &out = record.legs.at(0).arrivals, &back = record.legs.at(1).arrivals;
  const double c_source = simulator.paths().speed_at(s.platforms[0].track.start.position),
               c_target = simulator.paths().speed_at(s.targets[0].track.start.position);
  ASSERT_EQ(out.size(), back.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_NEAR(out[i].delay, back[i].delay, 1e-9);
    EXPECT_NEAR(out[i].launch_elevation, -back[i].arrival_elevation, 1e-7);
    const double widths = spreading == Spreading::plane
                              ? 1.0
                              : std::cos(out[i].launch_elevation) / c_source /
                                    (std::cos(out[i].arrival_elevation) / c_target);
    EXPECT_LT(std::abs(out[i].amplitude - back[i].amplitude * std::sqrt(widths)),
              1e-5 * std::abs(out[i].amplitude));
  }
}

TEST(Transect, ReciprocityOverASlope) {
  expect_reversed(Spreading::plane);
  expect_reversed(Spreading::cylindrical);
}

/// The delay of the path like `like` between two places [s].
double delay_of(const Scenario& s, const Vec3& from, const Vec3& to, const Arrival& like) {
  double best = infinity, delay = 0.0;
  for (const Arrival& a : paths_by_hand(s, from, to)) {
    if (a.surface_bounces != like.surface_bounces || a.bottom_bounces != like.bottom_bounces)
      continue;
    const double miss = std::abs(a.launch_elevation - like.launch_elevation);
    if (miss < best) best = miss, delay = a.delay;
  }
  return delay;
}

// Target and vehicle move across the slope: every path pair against a fixed-point iteration that
// searches each plane anew and linearises nothing, 1 µs.
TEST(Transect, DelaysOfMovingTargetsAreThoseOfAFixedPoint) {
  Scenario s = wedge();
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.platforms[0].track.start.velocity = {1.5, 2.0, 0.0};
  s.targets[0].track.start.velocity = {7.0, -3.0, 0.0};
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  ASSERT_GE(record.echoes.size(), 9U);
  for (const EchoPath& echo : record.echoes) {
    const Arrival& out = record.legs[0].arrivals[std::size_t(echo.outgoing)];
    const Arrival& home = record.legs[1].arrivals[std::size_t(echo.returning)];
    const Vec3 source = s.platforms[0].track.at(0.0).position;
    double struck = out.delay, received = struck + home.delay;
    for (int i = 0; i < 4; ++i)
      struck = delay_of(s, source, s.targets[0].track.at(struck).position, out);
    const Vec3 at = s.targets[0].track.at(struck).position;
    for (int i = 0; i < 4; ++i)
      received = struck + delay_of(s, at, s.platforms[0].track.at(received).position, home);
    EXPECT_NEAR(echo.received.delay, received, 1e-6) << echo.outgoing << ' ' << echo.returning;
  }
}

// A flat sea floor drawn with two nodes is marched over, a flat one is not: the same echoes to
// 1e-6, in delay and in amplitude.
TEST(Transect, AFlatShapeIsTheLayeredOcean) {
  Scenario layered = wedge();
  layered.environment.bottom.shape.reset();
  layered.propagation.diffraction = false;  // rays that graze the surface are waves in layers alone
  Scenario shaped = layered;
  shaped.environment.bottom.shape =
      BoundaryShape(std::vector{-5000.0, 9000.0}, std::vector{900.0, 900.0},
                    ShapeInterpolation::piecewise_linear);
  const PingRecord a = PingSimulator(layered).simulate(1), b = PingSimulator(shaped).simulate(1);
  ASSERT_EQ(a.echoes.size(), b.echoes.size());
  ASSERT_GE(a.echoes.size(), 25U);
  for (std::size_t i = 0; i < a.echoes.size(); ++i) {
    EXPECT_NEAR(a.echoes[i].received.delay, b.echoes[i].received.delay, 1e-6);
    EXPECT_LT(std::abs(a.echoes[i].received.amplitude - b.echoes[i].received.amplitude),
              1e-6 * std::abs(a.echoes[i].received.amplitude));
  }
}

/// Reverberation over the wedge, short: 6 sectors, two of them straight across the slope.
Scenario reverberant() {
  Scenario s = wedge();
  s.targets.clear();
  s.reverberation = {.enabled = true, .azimuths = 6, .ground_spacing = 20.0};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.pings.recording_duration = 5.0;
  return s;
}

BoundaryFan ground_of(const Scenario& s, const PropagationPaths& paths) {
  return *BoundaryFans(paths).around(s.platforms[0].track.start.position, BoundaryKind::surface,
                                     {.sectors = s.reverberation.azimuths,
                                      .spacing = 20.0,
                                      .max_range = 4000.0,
                                      .frequency = 4000.0,
                                      .limits = limits_of(s.propagation)});
}

/// The cell of that centre; none where cells are finer, as right above a platform of a layered
/// ocean.
std::optional<std::size_t> cell_there(const BoundaryPaths& paths, double range) {
  const auto cell = static_cast<std::size_t>(paths.grid().at(range));
  if (cell >= paths.cells() || std::abs(paths.range(cell) - range) > 1e-6) return std::nullopt;
  return cell;
}

/// Cell by cell, from straight above to the limiting ray: the same paths.
/// \param delay, grazing, amplitude  allowed differences [s], [rad], relative
void expect_same(const BoundaryPaths& a, const BoundaryPaths& b, double delay, double grazing,
                 double amplitude) {
  std::size_t compared = 0;
  for (std::size_t cell = 0; cell < a.cells(); ++cell) {
    const std::optional<std::size_t> in_b = cell_there(b, a.range(cell));
    if (!in_b) continue;
    ++compared;
    ASSERT_EQ(a.paths(cell).size(), b.paths(*in_b).size()) << cell;
    for (const BoundaryPath& p : a.paths(cell)) {
      const auto unlike = [&](const BoundaryPath& other) {
        return std::abs(other.launch_elevation - p.launch_elevation) +
               std::abs(other.delay - p.delay);
      };
      const auto all = b.paths(*in_b);
      const auto nearest = std::min_element(
          all.begin(), all.end(),
          [&](const BoundaryPath& x, const BoundaryPath& y) { return unlike(x) < unlike(y); });
      EXPECT_NEAR(nearest->delay, p.delay, delay) << cell;
      EXPECT_NEAR(nearest->grazing, p.grazing, grazing) << cell;
      EXPECT_LT(std::abs(nearest->amplitude - p.amplitude), amplitude * std::abs(p.amplitude))
          << cell;
    }
  }
  EXPECT_GT(compared, std::min(a.cells(), b.cells()) / 2);
}

// Across the slope nothing varies: that sector has the bits of a layered ocean of the platform's
// depth. Upslope and downslope have not.
TEST(Transect, TheSectorAcrossTheSlopeIsLayered) {
  const Scenario s = reverberant();
  const PropagationPaths paths(s.environment, s.transect);
  Environment here = s.environment;
  here.bottom.depth = paths.bottom_depth(s.platforms[0].track.start.position);
  here.bottom.shape.reset();
  const PropagationPaths layered(here, {});
  const BoundaryFan fan = ground_of(s, paths);
  const auto planes = fan.planes, ring = ground_of(s, layered).planes;
  ASSERT_EQ(planes.size(), 3U);
  ASSERT_EQ(ring.size(), 1U);
  for (const int sector : {1, 4})  // mirrored about the transect
    EXPECT_EQ(fan.towards(s.transect.bearing + 2.0 * pi * (sector + 0.5) / 6.0).paths,
              planes[1].paths);
  expect_same(*planes[1].paths, *ring[0].paths, 1e-12, 1e-12, 1e-12);
  const auto delays = [](const BoundaryPaths& ground) {
    double sum = 0.0;
    for (std::size_t cell = 0; cell < ground.cells(); ++cell)
      for (const BoundaryPath& path : ground.paths(cell)) sum += path.delay;
    return sum;
  };
  EXPECT_NE(delays(*planes[0].paths), delays(*planes[2].paths));
}

// A flat sea floor with two nodes: every sector is that of the layered ocean. Both grids are
// interpolated until range and delay are right to a hundredth of the spacing, 0.2 m: twice that and
// c = 1496 m/s, 2.7e-4 s; seen from 150 m below the surface, 2.7e-3 rad. Amplitudes are slopes of
// the interpolation: 1 %.
TEST(Transect, ReverberationOverAFlatShapeIsThatOfTheLayeredOcean) {
  Scenario flat = reverberant();
  flat.environment.bottom.shape.reset();
  Scenario shaped = flat;
  shaped.environment.bottom.shape =
      BoundaryShape(std::vector{-5000.0, 9000.0}, std::vector{900.0, 900.0},
                    ShapeInterpolation::piecewise_linear);
  const PropagationPaths a(flat.environment, flat.transect), b(shaped.environment, shaped.transect);
  const auto ring = ground_of(flat, a).planes, planes = ground_of(shaped, b).planes;
  for (const FanPlane& plane : planes)
    expect_same(*ring[0].paths, *plane.paths, 2.7e-4, 2.7e-3, 0.01);
}

/// Around the platform, in the plane of the first sector.
BoundaryPaths level_of(const Scenario& s, const PropagationPaths& paths, double depth) {
  return *BoundaryFans(paths)
              .around(s.platforms[0].track.start.position, GroundLevel(depth),
                      {.sectors = 6,
                       .spacing = 20.0,
                       .max_range = 4000.0,
                       .frequency = 4000.0,
                       .limits = limits_of(s.propagation)})
              ->planes[0]
              .paths;
}

// The same of a depth in the water, passed from above and below, before and after bounces, above
// and below the platform. Paths that turn within a cell of the level may be on either side of it:
// their cells have paths more or less, or an amplitude off by more than the rest's 1 % (it goes to
// infinity where dr/dα does): two at most. Lengths within
// twice the delays' tolerance, 0.8 m: they are linear over the mean speed.
TEST(Transect, LevelsOfTheWaterOverAFlatShapeAreThoseOfTheLayeredOcean) {
  Scenario flat = reverberant();
  flat.environment.bottom.shape.reset();
  Scenario shaped = flat;
  shaped.environment.bottom.shape =
      BoundaryShape(std::vector{-5000.0, 9000.0}, std::vector{900.0, 900.0},
                    ShapeInterpolation::piecewise_linear);
  const PropagationPaths a(flat.environment, flat.transect), b(shaped.environment, shaped.transect);
  for (const double depth : {40.0, 100.0, 400.0, 850.0}) {
    const BoundaryPaths layered = level_of(flat, a, depth), marched = level_of(shaped, b, depth);
    int unlike = 0, compared = 0;
    for (std::size_t cell = 0; cell < layered.cells(); ++cell) {
      const std::optional<std::size_t> there = cell_there(marched, layered.range(cell));
      if (!there) continue;
      if (layered.paths(cell).size() != marched.paths(*there).size()) {
        ++unlike;
        continue;
      }
      for (const BoundaryPath& p : layered.paths(cell)) {
        const auto off = [&](const BoundaryPath& other) {
          return std::abs(other.launch_elevation - p.launch_elevation) +
                 std::abs(other.delay - p.delay);
        };
        const auto all = marched.paths(*there);
        const auto same = std::min_element(
            all.begin(), all.end(),
            [&](const BoundaryPath& x, const BoundaryPath& y) { return off(x) < off(y); });
        EXPECT_NEAR(same->delay, p.delay, 2.7e-4) << depth << ' ' << cell;
        EXPECT_NEAR(same->length, p.length, 0.8) << depth << ' ' << cell;
        EXPECT_NEAR(same->grazing, p.grazing, 2.7e-3) << depth << ' ' << cell;
        EXPECT_EQ(same->downward, p.downward) << depth << ' ' << cell;
        if (std::abs(same->amplitude - p.amplitude) > 0.01 * std::abs(p.amplitude)) ++unlike;
        ++compared;
      }
    }
    EXPECT_GE(compared, 850) << depth;
    EXPECT_LE(unlike, 2) << depth;
  }
}

// Over the wedge a layer ends where the sea floor rises above it.
TEST(Transect, ALayerEndsWhereTheSeaFloorCutsIt) {
  const Scenario s = reverberant();
  const PropagationPaths paths(s.environment, s.transect);
  const BoundaryFan fan =
      *BoundaryFans(paths).around(s.platforms[0].track.start.position, GroundLevel(700.0),
                                  {.sectors = 6,
                                   .spacing = 20.0,
                                   .max_range = 6000.0,
                                   .frequency = 4000.0,
                                   .limits = limits_of(s.propagation)});
  const double here = paths.along(s.platforms[0].track.start.position);
  // 900 m − x/20 is 700 m at x = 4 km.
  const double upslope = (4000.0 - here) / std::cos(pi / 6.0);
  double furthest = 0.0;
  for (std::size_t cell = 0; cell < fan.planes[0].paths->cells(); ++cell)
    if (!fan.planes[0].paths->paths(cell).empty()) furthest = fan.planes[0].paths->range(cell);
  EXPECT_NEAR(furthest, upslope, 40.0);
  const BoundaryPaths& down = *fan.planes[2].paths;
  EXPECT_FALSE(down.paths(down.cells() - 1).empty());
}

// What a ping expects to receive of a layer: the layered ocean's within the grids' 1 % of amplitude
// (0.09 dB each way), from the first echo of the layer on.
TEST(Transect, VolumeReverberationOverAFlatShapeIsThatOfTheLayeredOcean) {
  const auto expected = [](bool shaped) {
    Scenario s = reverberant();
    s.environment.bottom.shape.reset();
    if (shaped)
      s.environment.bottom.shape =
          BoundaryShape(std::vector{-5000.0, 9000.0}, std::vector{900.0, 900.0},
                        ShapeInterpolation::piecewise_linear);
    s.reverberation.surface_scatters = false;
    s.reverberation.volume = {{.top = 350.0, .bottom = 450.0, .strength_db = -75.0}};
    const PropagationPaths paths(s.environment, s.transect);
    const Pulse pulse(s.pulse);
    const BeamPattern pattern(s.transmitters[0], 0.375);
    const ReverberationModel model(s, paths, pulse);
    const PingReverberation ping = model.ping(
        {.geometry = PingGeometry(s, {}, 1), .pattern = pattern, .pulse = pulse, .latest = 4.0});
    std::vector<double> levels;
    for (double t = 0.5; t < 4.0; t += 0.1) levels.push_back(ping.expected_db(t));
    return levels;
  };
  const auto layered = expected(false), shaped = expected(true);
  for (std::size_t i = 0; i < layered.size(); ++i)
    EXPECT_NEAR(shaped[i], layered[i], 0.2) << 0.5 + 0.1 * double(i);
}

// A surface that slopes by h′ along the transect, seen under β: sin(grazing) is |t·n| with the true
// normal n = (h′, −1)/√(1 + h′²) in (x, z) and t = (cos θ cos β, cos θ sin β, −sin θ).
TEST(Transect, GrazingAnglesAreThoseToTheTrueFacet) {
  Scenario s = reverberant();
  const double slope = 0.1;
  s.environment.surface.shape =
      BoundaryShape(std::vector{-9000.0, 9000.0}, std::vector{-900.0, 900.0},
                    ShapeInterpolation::piecewise_linear);
  s.environment.bottom = {.depth = 2000.0, .material = FluidHalfSpace{}, .shape = {}};
  s.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 0;
  s.platforms[0].track.start.position.z() += 900.0;
  const PropagationPaths paths(s.environment, s.transect);
  const auto fan = std::make_shared<const BoundaryFan>(ground_of(s, paths));
  const Vec3 platform = s.platforms[0].track.start.position;
  const BeamPattern omni({.beam = LineBeam{.taper = Taper::omnidirectional}}, 0.375);
  const ScatteringSheet sheet(
      fan, fan, NrlSurface{},
      {.source = {.position = platform}, .receiver = {.position = platform}, .frequency = 4000.0},
      omni);
  int compared = 0;
  PathPairs pairs;
  for (int sector = 0; sector < 6; ++sector) {
    const double beta = 2.0 * pi * (sector + 0.5) / 6.0, bearing = s.transect.bearing + beta;
    if (fan->towards(bearing).facets.empty()) continue;
    int found = 0;
    for (double range = 10.0; range < 4000.0; range += 20.0) {
      sheet.pairs_at(platform.head<2>() + range * Vec2(std::sin(bearing), std::cos(bearing)),
                     pairs);
      for (const PathPair& pair : pairs.found) {
        const double theta = pair.out->launch_elevation;  // straight rays, no bounces
        const double sine = std::abs(std::cos(theta) * std::cos(beta) * slope + std::sin(theta)) /
                            std::hypot(1.0, slope);
        EXPECT_NEAR(std::sin(pair.grazing_in), sine, 1e-6);
        EXPECT_NEAR(pair.area, std::hypot(1.0, slope), 1e-9);
        ++found;
      }
    }
    EXPECT_GT(found, 50);
    compared += found;
  }
  EXPECT_GT(compared, 300);
}

/// Everything at once over a wedge.
Scenario busy() {
  Scenario s = wedge();
  s.platforms[0].track.start.velocity = {1.5, 2.0, 0.0};
  s.targets[0].track.start.velocity = {7.0, -3.0, 0.0};
  s.reverberation = {.enabled = true, .azimuths = 5};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.pings = {.count = 4, .interval = 20.0, .recording_duration = 6.0};
  return s;
}

// The same bits for 1, 2 and 7 threads, and for a ping alone.
TEST(Transect, SameBitsForAnyThreads) {
  const auto run = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const PingSimulator simulator(busy());
    std::vector<PingRecord> records;
    run_pings(simulator, [&](PingRecord&& record) { records.push_back(std::move(record)); });
    return records;
  };
  const auto one = run(1);
  ASSERT_EQ(one.size(), 4U);
  EXPECT_FALSE(one[0].pressure == one[1].pressure);
  for (const std::size_t threads : {2U, 7U}) {
    const auto many = run(threads);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(many[i].pressure == one[i].pressure) << i;
  }
  EXPECT_TRUE(PingSimulator(busy()).simulate(3).pressure == one[2].pressure);
}

}  // namespace
}  // namespace asdic::detail
