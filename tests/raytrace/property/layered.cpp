#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/units.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/ocean/tube_amplitude.h"
#include "raytrace/paths/boundary_paths.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/paths/trace_ray.h"
#include "support/test_id.h"

namespace asdic::detail {
namespace {

/// A 31-sample table of Munk's profile with the thesis's depths, under each rule; and the profile
/// itself.
struct NamedProfile {
  std::string first;
  SoundSpeedProfile second;
  friend void PrintTo(const NamedProfile& p, std::ostream* out) { *out << p.first; }
};

std::vector<NamedProfile> profiles() {
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  std::vector<double> depth, speed;
  for (double z = 0.0; z <= 6000.0; z += 200.0) {
    depth.push_back(z);
    speed.push_back(munk.at(z).c);
  }
  std::vector<NamedProfile> all = {{"munk", munk},
                                   {"isovelocity", SoundSpeedProfile::isovelocity(1500.0)}};
  for (const Interpolation rule :
       {Interpolation::c_linear, Interpolation::n2_linear, Interpolation::spline,
        Interpolation::pchip, Interpolation::pchip_spline_slopes})
    all.push_back({std::string(name(rule)), SoundSpeedProfile::table(depth, speed, rule)});
  return all;
}

class EveryProfile : public testing::TestWithParam<NamedProfile> {
 protected:
  Environment ocean() const {
    Environment environment{.water = GetParam().second};
    environment.bottom.depth = 5000.0;
    return environment;
  }
};
INSTANTIATE_TEST_SUITE_P(Layered, EveryProfile, testing::ValuesIn(profiles()),
                         [](const auto& test) { return support::test_id(test.param.first); });

// Rays kept from a search at another frequency, of other depths or within other limits, are those
// of a solver that keeps none: bit for bit.
TEST_P(EveryProfile, KeptRaysAreThoseOfANewSolver) {
  const EigenraySolver solver(ocean());
  const auto ask = [](const EigenraySolver& of, double receiver, double frequency, int bounces) {
    return of.find(4500.0, receiver, 12.5e3, frequency,
                   {.max_surface_bounces = bounces, .max_bottom_bounces = bounces});
  };
  for (const double frequency : {3500.0, 300.0, 3500.0})
    for (const double receiver : {125.0, 126.0})
      for (const int bounces : {2, 1}) {
        const Arrivals kept = ask(solver, receiver, frequency, bounces),
                       searched = ask(EigenraySolver(ocean()), receiver, frequency, bounces);
        ASSERT_EQ(kept.size(), searched.size());
        ASSERT_FALSE(kept.empty());
        for (std::size_t i = 0; i < kept.size(); ++i) {
          EXPECT_EQ(kept[i].delay, searched[i].delay);
          EXPECT_EQ(kept[i].amplitude, searched[i].amplitude);
          EXPECT_EQ(kept[i].bounces.size(), searched[i].bounces.size());
        }
      }
}

// dr/dσ of every branch agrees with a central difference: it is what amplitudes and caustics come
// from. The difference of ranges that are right to 1e-10 (the quadrature) is wrong by 1e-10·r/h,
// its truncation by h²r‴/6 ≈ 1e-4 of the slope.
TEST_P(EveryProfile, RangeSlopeIsTheDerivative) {
  const EigenraySolver solver(ocean());
  const auto kept = solver.table(4500.0, 125.0, {});
  const BranchTable& table = *kept;
  int checked = 0;
  table.for_each_piece(0.0, 60e3, [&](const MonotonePiece& s) {
    if (s.sigma_end - s.sigma_begin < 1e-3)
      return;  // there the difference of two ranges right to 1e-10 says nothing
    const double sigma = 0.5 * (s.sigma_begin + s.sigma_end),
                 h = 1e-2 * (s.sigma_end - s.sigma_begin);
    const double difference = (table.evaluate(*s.interval, s.branch, sigma + h).range -
                               table.evaluate(*s.interval, s.branch, sigma - h).range) /
                              (2.0 * h);
    const auto exact = table.evaluate(*s.interval, s.branch, sigma);
    EXPECT_NEAR(exact.slope, difference, 1e-4 * std::abs(difference) + 1e-9 * exact.range / h)
        << "sigma " << sigma << " vertices " << s.branch.vertices;
    ++checked;
  });
  EXPECT_GT(checked, 50);
}

// As many rays at once get the amplitudes of the plain formulae: the same products in the same
// order, so that the spreading has the same bits. e^−x is right to 1e-15 (LaneMath), its argument
// of less than 3 nepers to four roundings.
TEST_P(EveryProfile, AmplitudesAreThoseOfTheirTubes) {
  Environment environment = ocean();
  environment.bottom.material = FluidHalfSpace{};
  environment.absorption = Thorp{};
  const EigenraySolver solver(environment);
  int checked = 0;
  for (const double receiver : {125.0, 800.0, 1300.0})
    for (const double range : {300.0, 17e3, 41e3}) {
      for (const Arrival& a : solver.find(1000.0, receiver, range, 5000.0)) {
        const RayTube tube{.speed = environment.water.at(receiver).c,
                           .q = a.q,
                           .range = range,
                           .launch_slowness = a.horizontal_slowness};
        EXPECT_DOUBLE_EQ(a.spreading, tube_amplitude(Spreading::cylindrical, tube));
        const std::complex<double> plain = path_amplitude(
            a.spreading, amplitude_from_db(-a.absorption_db), a.reflection, a.caustics);
        EXPECT_LT(std::abs(a.amplitude - plain), 4e-15 * std::abs(plain));
        ++checked;
      }
    }
  EXPECT_GT(checked, 50);
}

// A traced ray with an eigenray's launch angle passes through the receiver at the eigenray's delay,
// after its bounces.
TEST_P(EveryProfile, EigenraysAreRays) {
  const EigenraySolver solver(ocean());
  for (const double range : {3e3, 17e3, 41e3}) {
    const Arrivals arrivals = solver.find(4500.0, 125.0, range, 1000.0);
    EXPECT_GE(arrivals.size(), 4U);
    for (const Arrival& a : arrivals) {
      const RayPath ray = trace_ray(ocean(), 4500.0, a.launch_elevation, range);
      // A launch angle is right to a rounding of 1e-16/sin θ₀; at 41 km that is far below a
      // millimetre.
      EXPECT_NEAR(ray.points.back().depth, 125.0, 1e-3);
      EXPECT_NEAR(ray.points.back().time, a.delay, 1e-7);
      EXPECT_NEAR(ray.path_length, a.path_length, 1e-4);
      EXPECT_NEAR(ray.final_elevation, a.arrival_elevation, 1e-6);
      EXPECT_EQ(ray.surface_bounces, a.surface_bounces);
      EXPECT_EQ(ray.bottom_bounces, a.bottom_bounces);
      EXPECT_EQ(ray.turns, a.upper_turns + a.lower_turns);
    }
  }
}

// Recall: every change of side of a dense fan of independent rays at the receiver's range has an
// eigenray between its two launch angles.
TEST_P(EveryProfile, NoEigenrayOfADenseFanIsMissed) {
  const Environment environment = ocean();
  const EigenraySolver solver(environment);
  constexpr int rays = 3000;
  for (const double zr : {20.0, 800.0, 1300.0}) {
    const double zs = 1000.0, range = 35e3;
    const Arrivals arrivals = solver.find(
        zs, zr, range, 1000.0,
        {.max_surface_bounces = 100, .max_bottom_bounces = 100, .max_launch_angle = radians(60.0)});
    double previous = 0.0, previous_angle = 0.0;
    int previous_history = -1;
    for (int i = 0; i < rays; ++i) {
      const double angle = radians(-45.0 + 90.0 * (i + 0.37) / rays);
      const RayPath ray = trace_ray(environment, zs, angle, range, 500.0);
      const double miss = ray.points.back().depth - zr;
      const int history = ray.surface_bounces * 10000 + ray.bottom_bounces * 100 + ray.turns;
      if (history == previous_history && (miss > 0.0) != (previous > 0.0)) {
        const bool found = std::any_of(arrivals.begin(), arrivals.end(), [&](const Arrival& a) {
          return a.launch_elevation > previous_angle - 1e-9 && a.launch_elevation < angle + 1e-9;
        });
        EXPECT_TRUE(found) << "receiver at " << zr << " m: none between " << degrees(previous_angle)
                           << " and " << degrees(angle) << " deg";
      }
      previous = miss;
      previous_angle = angle;
      previous_history = history;
    }
  }
}

// Exchanging source and receiver reverses every path: same delay and amplitude, angles exchanged.
// A² = c_r c_s ξ/(r·|dr/dξ|·sin θ₀·sin θ_r) shows it (constant density; Jensen et al. (2011),
// sec. 2.2).
TEST_P(EveryProfile, Reciprocity) {
  const EigenraySolver solver(ocean());
  const double zs = 4500.0, zr = 300.0;
  const Arrivals there = solver.find(zs, zr, 23e3, 1000.0),
                 back = solver.find(zr, zs, 23e3, 1000.0);
  ASSERT_EQ(there.size(), back.size());
  for (std::size_t i = 0; i < there.size(); ++i) {
    EXPECT_NEAR(there[i].delay, back[i].delay, 1e-10);
    EXPECT_NEAR(there[i].launch_elevation, -back[i].arrival_elevation, 1e-8);
    EXPECT_NEAR(there[i].spreading, back[i].spreading, 1e-6 * there[i].spreading);
    EXPECT_EQ(there[i].caustics, back[i].caustics);
  }
}

// Paths gridded on a ground grid are the eigenrays to the cells' centres, but for those that a
// caustic's limit holds down.
TEST_P(EveryProfile, BoundaryPathsAreEigenraysToTheSurface) {
  const Environment environment = ocean();
  const EigenraySolver solver(environment);
  const PathLimits limits{.max_surface_bounces = 1, .max_bottom_bounces = 1};
  const BoundaryPaths ground =
      boundary_paths(solver, 4500.0, BoundaryKind::surface, 25.0, 40e3, 4000.0, limits);
  std::size_t compared = 0, matched = 0;
  for (std::size_t cell = 40; cell < ground.cells(); cell += 97) {
    Arrivals exact = solver.find(4500.0, 0.0, ground.range(cell), 4000.0, limits);
    std::erase_if(exact,
                  [](const Arrival& a) { return a.arrival_elevation < 0.0; });  // incident only
    EXPECT_EQ(ground.paths(cell).size(), exact.size()) << "range " << ground.range(cell);
    for (const BoundaryPath& p : ground.paths(cell)) {
      const auto near =
          std::min_element(exact.begin(), exact.end(), [&](const Arrival& a, const Arrival& b) {
            return std::abs(a.launch_elevation - p.launch_elevation) <
                   std::abs(b.launch_elevation - p.launch_elevation);
          });
      ASSERT_NE(near, exact.end());
      ++compared;
      // 0.01 of 25 m in range and in delay·c.
      EXPECT_NEAR(p.delay, near->delay, 0.3 / 1500.0);
      EXPECT_NEAR(p.grazing, near->arrival_elevation, radians(0.05));
      matched +=
          std::abs(db_from_amplitude(std::abs(p.amplitude) / std::abs(near->amplitude))) < 0.1;
    }
  }
  EXPECT_GT(compared, 30U);
  EXPECT_GE(double(matched), 0.95 * double(compared));
}

}  // namespace
}  // namespace asdic::detail
