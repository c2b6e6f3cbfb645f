#include <gtest/gtest.h>

#include <filesystem>

#include "io/bellhop/case_reader.h"
#include "io/bellhop/results.h"
#include "io/compare/arrivals.h"
#include "io/compare/rays.h"
#include "raytrace/propagation.h"

// Arrivals and rays against BELLHOP's converged runs (tests/data/bellhop/README.md). The bounds are
// those of the task: they lie above the converged files' own residuals (delays are float32: 2 to 4
// µs from 16 s on), but for the amplitude of the PCHIP case, whose residual is 0.267 dB.
namespace asdic::detail {
namespace {

namespace fs = std::filesystem;

fs::path folder(const std::string& name) { return fs::path(ASDIC_TEST_DATA) / "bellhop" / name; }

struct ArrivalCase {
  const char* name;
  double amplitude_db;
};

class BellhopArrivals : public testing::TestWithParam<ArrivalCase> {};
INSTANTIATE_TEST_SUITE_P(Converged, BellhopArrivals,
                         testing::Values(ArrivalCase{"deep-source-arrivals", 0.15},
                                         ArrivalCase{"deep-source-arrivals-pchip", 0.267},
                                         ArrivalCase{"elastic-arrivals", 0.15}));

TEST_P(BellhopArrivals, AreThoseOfTheConvergedRun) {
  const auto [name, amplitude_db] = GetParam();
  const bellhop::Input input = bellhop::read_case(folder(name) / "case");
  const bellhop::ArrivalsFile ours =
      bellhop::arrivals_file(input.run_case, run(input.run_case), input.binary_arrivals);
  const bellhop::ArrivalsFile converged =
      bellhop::read_arrivals_file(folder(name) / "converged" / "case.arr");
  const compare::ArrivalDifference d =
      compare::compare_arrivals(ours, converged, {.max_delay_difference = 200e-6});
  EXPECT_GE(d.matched_pct(), 99.0);
  EXPECT_EQ(d.strong_matched, d.strong_b);
  EXPECT_LE(d.delay_us.p95, 4.0);
  EXPECT_LE(d.amplitude_db.p95, amplitude_db);
  EXPECT_LE(d.launch_deg.p95, 0.02);
  EXPECT_LE(d.arrival_deg.p95, 0.02);
  // What BELLHOP has besides are beams that reach past the end of a family of rays.
  for (const compare::MissedPath& path : d.missed) EXPECT_LT(path.level_db, -20.0);
}

TEST(BellhopRays, UpslopeWithinAMetreOfTheConvergedRun) {
  const bellhop::Input input = bellhop::read_case(folder("rays-upslope") / "case");
  const bellhop::RayFile ours = bellhop::ray_file(input.run_case, run(input.run_case));
  const bellhop::RayFile converged =
      bellhop::read_ray_file(folder("rays-upslope") / "converged" / "case.ray");
  const compare::RayDifference d = compare::compare_rays(ours, converged);
  EXPECT_EQ(d.rays_a, 21U);
  EXPECT_EQ(d.paired, 21U);
  EXPECT_LT(d.inside_m.max, 1.0);
}

// Exact eigenrays: each ends at its receiver, and there is one row for each path.
TEST(BellhopRays, EigenraysEndAtTheirReceivers) {
  const bellhop::Input input = bellhop::read_case(folder("eigenrays-channel") / "case");
  PropagationCase both = input.run_case;
  both.task = Task::eigenrays_and_arrivals;
  const PropagationResult result = run(both);
  ASSERT_EQ(result.rays.size(), 1U);
  std::size_t paths = 0;
  for (std::size_t i = 0; i < result.arrivals.size(); ++i)
    for (const Arrival& a : result.arrivals[i]) {
      const RayPath& ray = result.rays[0][paths++];
      EXPECT_EQ(ray.launch_elevation, a.launch_elevation);
      EXPECT_NEAR(ray.points.back().range, both.receivers.ranges[i], 1e-3);
      EXPECT_NEAR(ray.points.back().depth, both.receivers.depths[0], 1e-3);
      EXPECT_NEAR(ray.points.back().time, a.delay, 1e-6);
      EXPECT_EQ(ray.surface_bounces, a.surface_bounces);
      EXPECT_EQ(ray.bottom_bounces, a.bottom_bounces);
    }
  EXPECT_EQ(paths, result.rays[0].size());
  EXPECT_GE(paths, 7U);
}

}  // namespace
}  // namespace asdic::detail
