// How far apart the rays of a point source are across their plane, docs/theory/rays.md: in a sea
// that is the same across it, against images in three dimensions and against rays in three
// dimensions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "raytrace/ocean/slice.h"
#include "raytrace/paths/boundary_paths.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/propagation.h"
#include "raytrace/runs/field_run.h"
#include "support/oceans.h"

namespace asdic::detail {
namespace {

constexpr double speed = 1500.0;

/// A wedge of uniform water under a pressure-release surface: the bottom rises at an angle to an
/// apex at range `apex`, and is a plane from 60 km before it (the nodes) to a centimetre of water.
struct Wedge {
  double angle = radians(6.0);  ///< [rad]
  double apex = 10e3;           ///< [m]
  BoundaryMaterial material = Rigid{};

  [[nodiscard]] Environment sea() const {
    const double slope = std::tan(angle);
    Environment sea{.water = SoundSpeedProfile::isovelocity(speed)};
    sea.bottom = {.depth = apex * slope, .material = material};
    sea.bottom.shape =
        BoundaryShape(std::vector{apex - 60e3, apex - 0.01 / slope},
                      std::vector{60e3 * slope, 0.01}, ShapeInterpolation::piecewise_linear);
    return sea;
  }
  [[nodiscard]] double sign_of_bottom() const {
    return std::holds_alternative<Rigid>(material) ? 1.0 : -1.0;
  }
};

/// The image of a source that a sequence of mirrors makes: the length of the way, and its mirrors.
struct Image {
  double way = 0.0;    ///< [m]
  double ahead = 0.0;  ///< how far towards the apex the way begins to lead [m]
  int surface = 0, bottom = 0;
  double sign = 1.0;
};

/// Every image that a receiver sees. With the angle φ from the surface about the apex the images of
/// a source at φ_s lie at the same distance from the apex, at 2mβ ± φ_s; a straight way to one of
/// them crosses the faces' images in order as long as it turns about the apex by less than π.
std::vector<Image> images(const Wedge& wedge, double source, double range, double depth,
                          int most_mirrors) {
  const double rs = std::hypot(wedge.apex, source), rr = std::hypot(wedge.apex - range, depth);
  const double phi_s = std::atan2(source, wedge.apex),
               phi_r = std::atan2(depth, wedge.apex - range);
  std::vector<Image> all;
  for (int m = -most_mirrors; m <= most_mirrors; ++m)
    for (const double side : {1.0, -1.0}) {
      const double turn = std::abs(2.0 * m * wedge.angle + side * phi_s - phi_r);
      Image image;
      image.ahead = wedge.apex - rr * std::cos(phi_r - 2.0 * m * wedge.angle);
      image.bottom = std::abs(m);
      image.surface = side > 0.0 ? std::abs(m) : m > 0 ? m - 1 : 1 - m;
      if (turn >= pi || std::max(image.bottom, image.surface) > most_mirrors) continue;
      image.way = std::sqrt(rs * rs + rr * rr - 2.0 * rs * rr * std::cos(turn));
      image.sign = (image.surface % 2 == 0 ? 1.0 : -1.0) *
                   (image.bottom % 2 == 0 ? 1.0 : wedge.sign_of_bottom());
      all.push_back(image);
    }
  return all;
}

/// Source, range and depth of the receiver [m].
struct Places {
  double source, range, depth;
};

// The amplitude of a path between perfect planes in uniform water is 1/R in three dimensions,
// whatever its reflections. Cylindrical spreading is 0.1 dB off at one bounce in the wedge of 6°
// and 2 dB at six.
TEST(SpreadingAcrossThePlane, OfAWedgeIsThatOfItsImages) {
  std::size_t paths = 0;
  double worst_cylinder = 0.0;
  for (const double angle : {pi / 30.0, pi / 18.0, 0.05, 0.3})
    for (const double apex : {10e3, -4e3})  // up the slope, and down it
      for (const BoundaryMaterial& material :
           {BoundaryMaterial(Rigid{}), BoundaryMaterial(Vacuum{})})
        for (const Places& at : {Places{60.0, 4000.0, 40.0}, Places{190.0, 2000.0, 100.0},
                                 Places{100.0, 6000.0, 150.0}}) {
          Wedge wedge{.angle = angle, .apex = std::abs(apex), .material = material};
          Environment sea = wedge.sea();
          if (apex < 0.0) sea = slice(sea, 0.0, -1.0);  // seen the other way
          const double range = apex < 0.0 ? -at.range : at.range;
          if (at.depth >= sea.bottom.depth_at(at.range) || at.source >= sea.bottom.depth_at(0.0))
            continue;
          constexpr int most = 3;
          const PathLimits limits{.max_surface_bounces = most, .max_bottom_bounces = most};
          const Arrivals found =
              EigenraySolver(sea).find(at.source, at.depth, at.range, 1000.0, limits);
          sea.spreading = Spreading::cylindrical;
          const Arrivals cylindrical =
              EigenraySolver(sea).find(at.source, at.depth, at.range, 1000.0, limits);
          ASSERT_EQ(found.size(), cylindrical.size());
          auto seen = images(wedge, at.source, range, at.depth, most);
          std::erase_if(seen, [&](const Image& image) { return image.ahead * range < 0.0; });
          EXPECT_EQ(found.size(), seen.size()) << angle << ' ' << apex << ' ' << at.range;
          for (const Image& image : seen) {
            const auto path = std::find_if(found.begin(), found.end(), [&](const Arrival& a) {
              return a.surface_bounces == image.surface && a.bottom_bounces == image.bottom &&
                     std::abs(a.delay * speed - image.way) < 1e-3;
            });
            ASSERT_NE(path, found.end()) << angle << ' ' << image.surface << ' ' << image.bottom;
            ++paths;
            const std::complex<double> exact = image.sign / image.way;
            EXPECT_NEAR(std::abs(path->amplitude - exact) * image.way, 0.0, 1e-6);
            const Arrival& other = cylindrical[std::size_t(path - found.begin())];
            worst_cylinder = std::max(
                worst_cylinder, std::abs(db_from_amplitude(std::abs(other.amplitude) * image.way)));
          }
        }
  EXPECT_GT(paths, 300U);
  EXPECT_GT(worst_cylinder, 2.0);  // what this is about
}

// Swapping source and receiver changes nothing, up, down and along a slope, under laws of every
// kind.
TEST(SpreadingAcrossThePlane, IsReciprocal) {
  std::size_t paths = 0;
  for (const support::CurvedOcean& ocean : support::curved_oceans()) {
    const PathLimits limits{
        .max_surface_bounces = 2, .max_bottom_bounces = 2, .max_launch_angle = 1.2};
    const double source = 70.0, receiver = 210.0, range = 6100.0;
    const Arrivals there =
        EigenraySolver(ocean.environment).find(source, receiver, range, 1000.0, limits);
    const Arrivals back = EigenraySolver(slice(ocean.environment, range, -1.0))
                              .find(receiver, source, range, 1000.0, limits);
    for (const Arrival& a : there) {
      const auto b = std::min_element(back.begin(), back.end(), [&](const auto& x, const auto& y) {
        return std::abs(x.delay - a.delay) < std::abs(y.delay - a.delay);
      });
      ASSERT_NE(b, back.end()) << ocean.name;
      if (std::abs(b->delay - a.delay) > 1e-9 || b->bottom_bounces != a.bottom_bounces) continue;
      // next to a caustic q is what is left of large numbers
      if (std::abs(a.q) < 0.05 * range) continue;
      ++paths;
      EXPECT_NEAR(std::norm(a.amplitude / b->amplitude), 1.0, 1e-4) << ocean.name;
    }
  }
  EXPECT_GT(paths, 40U);
}

/// A ray in three dimensions through c = c₀ + a·x + b·z + d·x·z, over a bottom z = h + s·x: plain
/// Runge–Kutta in time, to the bottom by halving the step.
struct PlainRay3 {
  using State = std::array<double, 6>;  // place and slowness
  double c0, a, b, d, h, s;

  [[nodiscard]] double c(const State& y) const {
    return c0 + a * y[0] + b * y[2] + d * y[0] * y[2];
  }
  [[nodiscard]] State rate(const State& y) const {
    const double c2 = c(y) * c(y), per_c = -1.0 / c(y);
    return {c2 * y[3], c2 * y[4], c2 * y[5], per_c * (a + d * y[2]), 0.0, per_c * (b + d * y[0])};
  }
  [[nodiscard]] State step(const State& y, double t) const {
    const auto plus = [](const State& x, const State& k, double f) {
      State r = x;
      for (std::size_t i = 0; i < r.size(); ++i) r[i] += f * k[i];
      return r;
    };
    const State k1 = rate(y), k2 = rate(plus(y, k1, 0.5 * t)), k3 = rate(plus(y, k2, 0.5 * t)),
                k4 = rate(plus(y, k3, t));
    return plus(plus(plus(plus(y, k1, t / 6.0), k2, t / 3.0), k3, t / 3.0), k4, t / 6.0);
  }
  /// Place after a time. \param up  launch elevation, \param aside  azimuth [rad]
  [[nodiscard]] std::array<double, 3> at(double source, double up, double aside,
                                         double time) const {
    State y{0.0, 0.0, source};
    const double n = 1.0 / c(y);
    y[3] = n * std::cos(up) * std::cos(aside), y[4] = n * std::cos(up) * std::sin(aside);
    y[5] = -n * std::sin(up);
    const auto above = [&](const State& x) { return h + s * x[0] - x[2]; };
    constexpr double longest = 2e-3;
    for (double left = time; left > 0.0;) {
      double t = std::min(longest, left);
      State next = step(y, t);
      if (above(next) < 0.0) {
        double low = 0.0, high = t;
        for (int i = 0; i < 60; ++i)
          (above(step(y, 0.5 * (low + high))) > 0.0 ? low : high) = 0.5 * (low + high);
        t = low;
        next = step(y, t);
        const double down = (next[5] - s * next[3]) / (1.0 + s * s);  // along n = (−s, 0, 1)
        next[3] += 2.0 * s * down;
        next[5] -= 2.0 * down;
        for (double extra = 1e-9; above(next) <= 0.0; extra *= 2.0) next[2] -= extra;
      }
      y = next;
      left -= t;
    }
    return {y[0], y[1], y[2]};
  }
};

// The width of a tube of rays in three dimensions, by differences, where speed and depth vary with
// range.
TEST(SpreadingAcrossThePlane, IsThatOfRaysInThreeDimensions) {
  const double c0 = 1500.0, a = 4e-3, b = -0.02, d = -3e-6, h = 800.0, s = -0.06;
  const PlainRay3 plain{c0, a, b, d, h, s};
  Environment sea;
  const std::vector<double> ranges = {-2000.0, 12000.0}, depths = {-100.0, 1500.0};
  std::vector<double> speeds;
  for (const double x : ranges)
    for (const double z : depths) speeds.push_back(c0 + a * x + b * z + d * x * z);
  sea.section = SoundSpeedSection(ranges, depths, speeds);
  sea.surface.depth = -50.0;
  sea.bottom = {.depth = h, .material = Rigid{}};
  sea.bottom.shape =
      BoundaryShape(std::vector{-2000.0, 11000.0}, std::vector{h - s * 2000.0, h + s * 11000.0},
                    ShapeInterpolation::piecewise_linear);
  const double source = 300.0;
  std::size_t paths = 0;
  for (const double range : {2500.0, 6000.0, 9000.0})
    for (const double depth : {90.0, 210.0})
      for (const Arrival& path : EigenraySolver(sea).find(
               source, depth, range, 1000.0,
               {.max_surface_bounces = 0, .max_bottom_bounces = 3, .max_launch_angle = 1.2})) {
        const double up = path.launch_elevation, t = path.delay, e = 1e-4;
        const auto end = plain.at(source, up, 0.0, t);
        ASSERT_NEAR(end[0], range, 0.02);
        ASSERT_NEAR(end[2], depth, 0.02);
        const auto higher = plain.at(source, up + e, 0.0, t),
                   lower = plain.at(source, up - e, 0.0, t), aside = plain.at(source, up, e, t);
        // the neighbours after the same time lie across the ray
        const double in_plane = std::hypot(higher[0] - lower[0], higher[2] - lower[2]) / (2.0 * e);
        const double across = aside[1] / e;
        const double c = c0 + a * range + b * depth + d * range * depth;
        const double exact =
            std::sqrt(c * std::cos(up) / (plain.c({0.0, 0.0, source}) * in_plane * across));
        ++paths;
        EXPECT_NEAR(db_from_amplitude(path.spreading / exact), 0.0, 1e-4)
            << range << ' ' << depth << ' ' << path.bottom_bounces;
      }
  EXPECT_GT(paths, 9U);
}

/// A sea that varies with range in name only, so that it is marched: under the profile's law, or as
/// a section.
Environment nominally_sloping(Environment sea, bool as_section) {
  const double depth = sea.bottom.depth;
  sea.bottom.shape =
      BoundaryShape(std::vector{-5000.0, 4000.0, 20000.0}, std::vector{depth, depth, depth},
                    ShapeInterpolation::piecewise_linear);
  if (!as_section) return sea;
  const auto z = sea.water.depths();
  std::vector<double> speeds;
  const std::vector<double> ranges = {-5000.0, 3000.0, 20000.0};
  for (std::size_t i = 0; i < ranges.size(); ++i)
    for (const double c : sea.water.speeds()) speeds.push_back(c);
  sea.section = SoundSpeedSection(ranges, z, speeds);
  return sea;
}

std::vector<Environment> level_seas() {
  const std::vector<double> z = {0.0, 60.0, 150.0, 300.0, 500.0, 900.0};
  const std::vector<double> c = {1520.0, 1518.0, 1505.0, 1496.0, 1494.0, 1499.0};
  std::vector<Environment> all;
  for (const auto law :
       {Interpolation::c_linear, Interpolation::n2_linear, Interpolation::spline}) {
    Environment sea{.water = SoundSpeedProfile::table(z, c, law)};
    sea.bottom = {.depth = 900.0, .material = Rigid{}};
    all.push_back(nominally_sloping(sea, false));
    if (law == Interpolation::c_linear) all.push_back(nominally_sloping(sea, true));
  }
  Environment munk{.water = SoundSpeedProfile::munk()};
  munk.bottom = {.depth = 4000.0, .material = Rigid{}};
  all.push_back(nominally_sloping(munk, false));
  return all;
}

// Where nothing does vary with range, ∫c ds = r·c₀/cos α, and both formulas are one: for every kind
// of beam, path and cell, whatever law carries the ray.
TEST(SpreadingAcrossThePlane, IsTheCylindersOverALevelSea) {
  for (const Environment& plane : level_seas()) {
    Environment cylinder = plane;
    cylinder.spreading = Spreading::cylindrical;
    const PathLimits limits{.max_surface_bounces = 2, .max_bottom_bounces = 2};
    const Arrivals a = EigenraySolver(plane).find(100.0, 200.0, 7000.0, 500.0, limits),
                   b = EigenraySolver(cylinder).find(100.0, 200.0, 7000.0, 500.0, limits);
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GT(a.size(), 3U);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i].spreading, b[i].spreading, 1e-9 * b[i].spreading);
    const BoundaryPaths on = boundary_paths(EigenraySolver(plane), 100.0, BoundaryKind::bottom,
                                            10.0, 6000.0, 500.0, limits);
    const BoundaryPaths of = boundary_paths(EigenraySolver(cylinder), 100.0, BoundaryKind::bottom,
                                            10.0, 6000.0, 500.0, limits);
    for (std::size_t cell = 0; cell < on.cells(); ++cell) {
      ASSERT_EQ(on.paths(cell).size(), of.paths(cell).size());
      for (std::size_t i = 0; i < on.paths(cell).size(); ++i)
        EXPECT_NEAR(std::abs(on.paths(cell)[i].amplitude / of.paths(cell)[i].amplitude), 1.0, 2e-4);
    }
  }
}

TEST(SpreadingAcrossThePlane, IsTheCylindersForEveryBeamOverALevelSea) {
  for (const Environment& sea : level_seas())
    for (int kind = 0; kind <= int(BeamKind::cerveny_ray_centred); ++kind)
      for (const FieldMethod method : {FieldMethod::fast, FieldMethod::plain}) {
        PropagationCase run_case{.frequency = 200.0, .environment = sea, .source_depths = {100.0}};
        run_case.beams = {.kind = BeamKind(kind), .lowest = -0.4, .highest = 0.4};
        run_case.beams.cerveny = CervenyBeams{};
        run_case.receivers.depths = support::samples(50.0, 850.0, 9);
        run_case.receivers.ranges = support::samples(500.0, 5000.0, 10);
        const BeamFan fan = even_fan(-0.4, 0.4, 301);
        const auto field = [&](Spreading spreading) {
          run_case.environment.spreading = spreading;
          return field_of_fan(run_case, RayTracer(run_case.environment, 200.0), 100.0, fan, {},
                              method)
              .field;
        };
        const auto a = field(Spreading::plane), b = field(Spreading::cylindrical);
        double error = 0.0, norm = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
          error += std::norm(a[i] - b[i]), norm += std::norm(b[i]);
        // served from the foot of a normal the range is the foot's, not the receiver's
        const bool by_feet = kind == int(BeamKind::ray_centred_hat) ||
                             kind == int(BeamKind::ray_centred_gaussian) ||
                             kind == int(BeamKind::cerveny_ray_centred);
        EXPECT_GT(norm, 0.0);
        EXPECT_LT(std::sqrt(error / norm), by_feet ? 0.02 : 1e-6) << kind;
      }
}

// The energy of all images, by beams. A hat is lost where a boundary lies between its ray's column
// and the receiver: the more beams, the rarer (10⁻⁶ dB at most of these receivers, and at all but
// one with four times as many).
TEST(SpreadingAcrossThePlane, OfAFieldInAWedge) {
  const Wedge wedge{.angle = radians(6.0), .apex = 10e3};
  PropagationCase run_case{.frequency = 100.0,
                           .environment = wedge.sea(),
                           .source_depths = {200.0},
                           .field = FieldKind::incoherent};
  run_case.beams = {.kind = BeamKind::hat, .lowest = radians(-89.9), .highest = radians(89.9)};
  run_case.receivers.depths = {60.0, 110.0};
  run_case.receivers.ranges = {2000.0, 4000.0, 7000.0};
  run_case.box_range = 12e3;
  const RayTracer tracer(run_case.environment, 100.0);
  const BeamFan fan = even_fan(run_case.beams.lowest, run_case.beams.highest, 20001);
  const auto field = field_of_fan(run_case, tracer, 200.0, fan).field;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < 3; ++j) {
      double energy = 0.0;
      for (const Image& image :
           images(wedge, 200.0, run_case.receivers.ranges[j], run_case.receivers.depths[k], 40))
        energy += 1.0 / (image.way * image.way);
      EXPECT_NEAR(db_from_power(std::norm(field[3 * k + j]) / energy), 0.0, 0.05)
          << run_case.receivers.ranges[j] << ' ' << run_case.receivers.depths[k];
    }
}

}  // namespace
}  // namespace asdic::detail
