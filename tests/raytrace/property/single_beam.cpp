#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/error.h"
#include "raytrace/propagation.h"

// The one beam that is wanted of a fan (LiteralSettings::single_beam), by asdic's own rays.

namespace asdic::detail {
namespace {

constexpr int beams = 41;

PropagationCase channel() {
  const double depth[] = {0.0, 80.0, 200.0}, speed[] = {1510.0, 1490.0, 1500.0};
  PropagationCase c;
  c.frequency = 200.0;
  c.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  c.environment.bottom = {.depth = 200.0, .material = FluidHalfSpace{}};
  c.source_depths = {60.0};
  c.receivers = {.depths = {30.0, 110.0, 190.0}, .ranges = {500.0, 2000.0, 4000.0}};
  c.beams.lowest = radians(-20.0);
  c.beams.highest = radians(25.0);
  c.box_range = 5000.0;
  c.box_depth = 250.0;
  c.literal.beams = beams;
  return c;
}

// Beams add up: the fields of all beams, each alone, are that of the fan as it is written.
TEST(SingleBeam, FieldsAddUpToTheFans) {
  for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian, BeamKind::cerveny_cartesian}) {
    PropagationCase c = channel();
    c.beams.kind = kind;
    for (int i = 0; i < beams; ++i)
      c.beams.elevations.push_back(std::lerp(c.beams.lowest, c.beams.highest, i / (beams - 1.0)));
    const auto whole = run(c).field;
    c.beams.elevations.clear();
    std::vector<std::complex<double>> sum(whole.size());
    std::vector<double> magnitude(whole.size());
    for (int i = 1; i <= beams; ++i) {
      c.literal.single_beam = i;
      const PropagationResult one = run(c);
      EXPECT_EQ(one.beams, 1U);
      EXPECT_EQ(one.notes.size(), 1U);
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] += std::complex<double>(one.field[k]);
        magnitude[k] += double(std::abs(one.field[k]));
      }
    }
    for (std::size_t k = 0; k < sum.size(); ++k)  // results are kept in float32
      EXPECT_LT(std::abs(sum[k] - std::complex<double>(whole[k])), 3e-5 * magnitude[k]) << k;
  }
}

// Each beam's paths are its share of the fan's: none is lost, none told twice.
TEST(SingleBeam, ArrivalsAreDividedAmongBeams) {
  PropagationCase c = channel();
  c.task = Task::arrivals;
  const double half = 0.5 * (c.beams.highest - c.beams.lowest) / (beams - 1);
  PropagationCase wide = c;
  wide.beams.lowest -= half;
  wide.beams.highest += half;
  const auto all = run(wide).arrivals;
  std::vector<double> count(all.size());
  for (int i = 1; i <= beams; ++i) {
    c.literal.single_beam = i;
    const auto some = run(c).arrivals;
    const double middle = std::lerp(c.beams.highest, c.beams.lowest, (i - 1) / (beams - 1.0));
    for (std::size_t k = 0; k < some.size(); ++k) {
      count[k] += double(some[k].size());
      for (const Arrival& a : some[k]) EXPECT_NEAR(a.launch_elevation, middle, half * 1.000001);
    }
  }
  for (std::size_t k = 0; k < all.size(); ++k) EXPECT_GE(count[k], double(all[k].size())) << k;
}

TEST(SingleBeam, IsOneRayOfARayRun) {
  PropagationCase c = channel();
  c.task = Task::rays;
  c.literal.single_beam = 1;  // the highest: BELLHOP's angles are positive down
  const auto rays = run(c).rays.at(0);
  ASSERT_EQ(rays.size(), 1U);
  EXPECT_NEAR(rays[0].launch_elevation, radians(25.0), 1e-12);
  c.literal.single_beam = beams + 1;
  EXPECT_THROW(static_cast<void>(run(c)), InputError);
}

// The box is a box: rays end as far above depth 0 as below it. A surface above it is never met.
TEST(Box, EndsRaysUpwardsToo) {
  PropagationCase c = channel();
  c.environment.surface.depth = -300.0;
  c.task = Task::rays;
  c.beams.lowest = radians(-60.0);
  c.beams.highest = radians(60.0);
  c.beams.count = 25;
  for (const bool layered : {true, false}) {
    if (!layered) c.environment.water = SoundSpeedProfile::munk({});
    double highest = 0.0;
    const PropagationResult result = run(c);
    for (const RayPath& ray : result.rays.at(0)) {
      for (const RayPoint& p : ray.points) highest = std::min(highest, p.depth);
      EXPECT_EQ(ray.surface_bounces, 0);
    }
    EXPECT_NEAR(highest, -c.box_depth, 1e-6);
  }
  c.task = Task::arrivals;  // none by way of the surface
  const PropagationResult paths = run(c);
  for (const Arrivals& here : paths.arrivals)
    for (const Arrival& a : here) EXPECT_EQ(a.surface_bounces, 0);
}

}  // namespace
}  // namespace asdic::detail
